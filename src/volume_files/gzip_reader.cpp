// SPDX-License-Identifier: Apache-2.0
#include "volume_files/gzip_reader.h"

#include <new>

namespace lamina {
namespace {

constexpr int gzip_or_zlib_window = 15 + 32;  // zlib.h, inflateInit2: detect the kind of header

}  // namespace

GzipReader::GzipReader(OpenedFile stream, std::string name)
    : PackedReader(std::move(stream), std::move(name), "gzip") {
    if (inflateInit2(&state_, gzip_or_zlib_window) != Z_OK) throw std::bad_alloc();
}

GzipReader::~GzipReader() {
    inflateEnd(&state_);
}

bool GzipReader::unpack(Input& from, Output& to) {
    state_.next_in = const_cast<Bytef*>(from.data());  // zlib only reads it
    state_.avail_in = static_cast<uInt>(from.size());
    state_.next_out = to.data();
    state_.avail_out = static_cast<uInt>(to.size());
    const int result = inflate(&state_, Z_NO_FLUSH);
    from = from.last(state_.avail_in);
    to = to.last(state_.avail_out);
    if (result == Z_STREAM_END) {
        inflateReset(&state_);
        return true;
    }
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK && result != Z_BUF_ERROR)
        fail_as_damaged(state_.msg != nullptr ? state_.msg : "no reason given");
    return false;
}

}  // namespace lamina
