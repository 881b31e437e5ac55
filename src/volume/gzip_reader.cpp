// SPDX-License-Identifier: Apache-2.0
#include "volume/gzip_reader.h"

#include <algorithm>
#include <new>

#include "base/error.h"
#include "base/interrupt.h"

namespace lamina {
namespace {

constexpr std::size_t input_bytes = std::size_t{1} << 20;
constexpr std::size_t output_step =
    std::size_t{1} << 26;  // zlib counts in 32 bits; also how often to look for Ctrl-C

constexpr int gzip_or_zlib_window = 15 + 32;  // zlib.h, inflateInit2: detect the kind of header

}  // namespace

GzipReader::GzipReader(std::FILE* stream, std::string file)
    : stream_(stream), file_(std::move(file)), input_(input_bytes) {
    if (inflateInit2(&state_, gzip_or_zlib_window) != Z_OK) throw std::bad_alloc();
}

GzipReader::~GzipReader() {
    inflateEnd(&state_);
}

bool GzipReader::inflate_some() {
    if (state_.avail_in == 0) {
        state_.next_in = input_.data();
        state_.avail_in = static_cast<uInt>(std::fread(input_.data(), 1, input_.size(), stream_));
        if (state_.avail_in == 0) return false;
    }
    const int result = inflate(&state_, Z_NO_FLUSH);
    if (result == Z_STREAM_END) {
        inflateReset(&state_);  // for the next member
    } else if (result == Z_MEM_ERROR) {
        throw std::bad_alloc();
    } else if (result != Z_OK && result != Z_BUF_ERROR) {
        fail("{}: damaged gzip data: {}", file_,
             state_.msg != nullptr ? state_.msg : "no reason given");
    }
    return true;
}

void GzipReader::read(void* bytes, std::size_t count) {
    auto* out = static_cast<unsigned char*>(bytes);
    std::size_t done = 0;
    while (done < count) {
        check_interrupt();
        const std::size_t step = std::min(count - done, output_step);
        state_.next_out = out + done;
        state_.avail_out = static_cast<uInt>(step);
        while (state_.avail_out > 0) {
            if (inflate_some()) continue;
            fail("{}: truncated gzip data: found {} bytes, expected {}", file_,
                 done + step - state_.avail_out, count);
        }
        done += step;
    }
}

void GzipReader::skip(std::size_t count) {
    std::vector<unsigned char> scratch(std::min(count, input_bytes));
    for (std::size_t done = 0; done < count;) {
        const std::size_t step = std::min(count - done, scratch.size());
        read(scratch.data(), step);
        done += step;
    }
}

void GzipReader::check_end() {
    // total_in is 0 again as soon as the member's trailer has been read and checked.
    while (state_.total_in != 0) {
        unsigned char beyond = 0;
        state_.next_out = &beyond;
        state_.avail_out = 1;
        if (!inflate_some()) fail("{}: truncated gzip data: the checksum is missing", file_);
        if (state_.avail_out == 0)
            return;  // more data than the header speaks of: not ours to check
    }
}

}  // namespace lamina
