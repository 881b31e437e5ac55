// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>

#include "base/error.h"
#include "lamina/image.h"
#include "support/temporary_folder.h"

namespace lamina {

// Returns an image whose components have both signs and magnitudes from 2^-140 (subnormal) to
// 2^100, or are 0.
inline Image random_image(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> mantissa(-1, 1);
    std::uniform_int_distribution<int> exponent(-140, 100);
    Image image(width, height);
    for (float& value : image.rgba) value = std::ldexp(mantissa(random), exponent(random));
    image.rgba[0] = 0;
    return image;
}

// Calls read(path) with every shortened version of the file `bytes`, which must throw Error, and
// with one bit of every byte inverted, which may throw Error and nothing else. Returns how many of
// the files with an inverted bit were refused.
template <typename Read>
int refusals_of_damaged(const std::string& bytes, const std::filesystem::path& path,
                        const Read& read) {
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        write_bytes_to(path, bytes.substr(0, length));
        EXPECT_THROW(read(path), Error) << "cut to " << length << " of " << bytes.size();
    }
    int refused = 0;
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
        write_bytes_to(path, damaged);
        try {
            read(path);
        } catch (const Error&) {
            ++refused;
        }
    }
    return refused;
}

}  // namespace lamina
