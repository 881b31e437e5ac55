// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "volume/volume_store.h"
#include "volume_files/volume_opening.h"

namespace lamina::test {

inline constexpr VolumeUse in_files{.residence = VolumeUse::Residence::in_files};

inline std::string noise_bytes(std::size_t count) {
    std::mt19937 random(5);
    std::string bytes(count, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    return bytes;
}

// Checks that a volume that stays in its files (`by_parts`) has the samples of the volume in memory
// (`whole`), in random boxes.
inline void expect_boxes(const Volume& whole, const Volume& by_parts, int trials = 200) {
    ASSERT_TRUE(whole.in_memory());
    ASSERT_FALSE(by_parts.in_memory());
    const auto& size = whole.grid().size;
    EXPECT_EQ(by_parts.grid().size, size);
    EXPECT_EQ(by_parts.grid().origin, whole.grid().origin);
    EXPECT_EQ(by_parts.grid().step, whole.grid().step);
    EXPECT_EQ(by_parts.grid().centering, whole.grid().centering);
    ASSERT_EQ(by_parts.type(), whole.type());
    const std::size_t bytes = bytes_of(whole.type());
    std::mt19937 random(1);
    for (int trial = 0; trial < trials; ++trial) {
        SampleBox box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.first[axis] = static_cast<std::int64_t>(random()) % size[axis];
            box.size[axis] =
                1 + static_cast<std::int64_t>(random()) % (size[axis] - box.first[axis]);
        }
        if (trial == 0) box = {{0, 0, 0}, size};
        std::string found(static_cast<std::size_t>(box.count()) * bytes, '\0'), expected;
        by_parts.store().source().read(box, found.data());
        for (std::int64_t z = 0; z < box.size[2]; ++z) {
            for (std::int64_t y = 0; y < box.size[1]; ++y) {
                const std::int64_t place =
                    ((box.first[2] + z) * size[1] + box.first[1] + y) * size[0] + box.first[0];
                expected.append(static_cast<const char*>(whole.data()) +
                                    static_cast<std::size_t>(place) * bytes,
                                static_cast<std::size_t>(box.size[0]) * bytes);
            }
        }
        ASSERT_EQ(found, expected) << trial;
    }
}

}  // namespace lamina::test
