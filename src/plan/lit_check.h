// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"

namespace lamina {

// Throw Error for a lit scene that the method cannot draw lit; nothing is drawn unlit instead.
void check_lit_slicing(const Scene& scene);
void check_lit_projection(const Scene& scene);

}  // namespace lamina
