// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "image/metrics.h"
#include "lamina/image.h"
#include "lamina/scene.h"

namespace lamina::papers {

// The scene with target `emulated` of 8 bits, as LaMar's hardware composites (2004, section 4).
Scene with_paper_hardware(Scene scene);

// Norms of one channel (0..3: R, G, B, A) of `image` - `exact`, in units of 1/255.
ErrorNorms channel_error(const Image& image, const Image& exact, std::size_t channel);

}  // namespace lamina::papers
