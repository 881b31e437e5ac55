// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina::view {

// Numbers of changes of each part of a scene, divided by what a change makes necessary
// (lamina/session.h).
struct Revisions {
    std::uint64_t data = 0;      // other data: all of it
    std::uint64_t settings = 0;  // and all that is not named here
    std::uint64_t transfer_function = 0, clip = 0, camera = 0, size = 0;
    bool operator==(const Revisions&) const = default;
};

}  // namespace lamina::view
