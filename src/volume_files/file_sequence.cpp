// SPDX-License-Identifier: Apache-2.0
#include "volume_files/file_sequence.h"

#include <algorithm>

#include "base/error.h"

namespace lamina {

template <typename Step>
void FileSequence::use(std::size_t count, const Step& step) {
    while (count > 0) {
        if (left_ == 0) {
            if (next_ == paths_.size())
                fail("{}: the last file ends {} bytes too early", paths_.back().string(), count);
            reader_ = open_(paths_[next_]);
            left_ = bytes_each_;
        }
        const std::size_t bytes = std::min(count, left_);
        step(*reader_, bytes);
        count -= bytes;
        left_ -= bytes;
        if (left_ > 0) continue;
        for (const std::string& more : reader_->surplus())
            surplus_.push_back(fmt::format("{} in {}", more, paths_[next_].string()));
        ++next_;
    }
}

void FileSequence::read(void* bytes, std::size_t count) {
    auto* to = static_cast<char*>(bytes);
    use(count, [&](ByteReader& reader, std::size_t step) {
        reader.read(to, step);
        to += step;
    });
}

void FileSequence::skip(std::size_t count) {
    use(count, [](ByteReader& reader, std::size_t step) { reader.skip(step); });
}

std::vector<std::string> FileSequence::surplus() {
    return surplus_;
}

}  // namespace lamina
