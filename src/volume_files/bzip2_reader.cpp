// SPDX-License-Identifier: Apache-2.0
#include "volume_files/bzip2_reader.h"

#include <new>

namespace lamina {

Bzip2Reader::Bzip2Reader(OpenedFile stream, std::string name)
    : PackedReader(std::move(stream), std::move(name), "bzip2") {
    begin_member();
}

Bzip2Reader::~Bzip2Reader() {
    BZ2_bzDecompressEnd(&state_);
}

void Bzip2Reader::begin_member() {
    constexpr int silent = 0, fast = 0;
    state_ = {};
    if (BZ2_bzDecompressInit(&state_, silent, fast) != BZ_OK) throw std::bad_alloc();
}

bool Bzip2Reader::unpack(Input& from, Output& to) {
    // libbz2 takes char* but only reads.
    state_.next_in = const_cast<char*>(reinterpret_cast<const char*>(from.data()));
    state_.avail_in = static_cast<unsigned>(from.size());
    state_.next_out = reinterpret_cast<char*>(to.data());
    state_.avail_out = static_cast<unsigned>(to.size());
    const int result = BZ2_bzDecompress(&state_);
    from = from.last(state_.avail_in);
    to = to.last(state_.avail_out);
    if (result == BZ_STREAM_END) {
        BZ2_bzDecompressEnd(&state_);
        begin_member();
        return true;
    }
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    if (result == BZ_DATA_ERROR_MAGIC) fail_as_damaged("no bzip2 header");
    if (result != BZ_OK) fail_as_damaged("its checksum or its codes are wrong");
    return false;
}

}  // namespace lamina
