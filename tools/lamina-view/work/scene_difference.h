// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/scene.h"

namespace lamina::view {

// Returns the keys that `asked` leaves to be chosen ("auto") and that differ in two choices, one
// line each: "render.slice.samples: 300 -> 320".
std::vector<std::string> automatic_differences(const Scene& before, const Scene& after,
                                               const Scene& asked);

}  // namespace lamina::view
