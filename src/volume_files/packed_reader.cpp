// SPDX-License-Identifier: Apache-2.0
#include "volume_files/packed_reader.h"

#include <algorithm>
#include <utility>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

constexpr std::size_t input_bytes = std::size_t{1} << 20;
// zlib and libbz2 count in 32 bits. This is also the number of bytes between checks for a requested
// stop.
constexpr std::size_t output_step = std::size_t{1} << 26;

}  // namespace

PackedReader::PackedReader(OpenedFile stream, std::string name, const char* format)
    : stream_(std::move(stream)), name_(std::move(name)), format_(format), input_(input_bytes) {}

void PackedReader::fail_as_damaged(const char* reason) const {
    fail("{}: damaged {} data: {}", name_, format_, reason);
}

bool PackedReader::unpack_some(Output& to) {
    if (left_.empty()) {
        const std::size_t got = std::fread(input_.data(), 1, input_.size(), stream_.get());
        left_ = Input(input_).first(got);
        if (got == 0) return false;
    }
    in_member_ = !unpack(left_, to);
    return true;
}

void PackedReader::read(void* bytes, std::size_t count) {
    auto* const first = static_cast<unsigned char*>(bytes);
    for (std::size_t done = 0; done < count;) {
        check_interrupt();
        Output to(first + done, std::min(count - done, output_step));
        done += to.size();
        while (!to.empty()) {
            if (unpack_some(to)) continue;
            fail("{}: truncated {} data: found {} bytes, expected {}", name_, format_,
                 done - to.size(), count);
        }
    }
}

void PackedReader::skip(std::size_t count) {
    std::vector<unsigned char> scratch(std::min(count, input_bytes));
    for (std::size_t done = 0; done < count;) {
        const std::size_t step = std::min(count - done, scratch.size());
        read(scratch.data(), step);
        done += step;
    }
}

PackedReader::Surplus PackedReader::rest() {
    Surplus surplus;
    std::vector<unsigned char> scratch(input_bytes);
    while (in_member_ && surplus.unpacked < most_unpacked) {
        check_interrupt();
        Output to(scratch);
        if (!unpack_some(to)) {
            fail("{}: truncated {} data: the checksum is missing", name_, format_);
        }
        surplus.unpacked += scratch.size() - to.size();
    }
    if (!in_member_) surplus.behind = left_.size() + bytes_left(stream_.get());
    return surplus;
}

std::vector<std::string> PackedReader::surplus() {
    const Surplus found = rest();
    std::vector<std::string> texts;
    if (found.unpacked > 0) {
        const char* const at_least = found.unpacked >= most_unpacked ? "at least " : "";
        texts.push_back(
            fmt::format("{}{} bytes of {} data more", at_least, found.unpacked, format_));
    }
    if (found.behind > 0)
        texts.push_back(fmt::format("{} bytes behind its {} data, more", found.behind, format_));
    return texts;
}

}  // namespace lamina
