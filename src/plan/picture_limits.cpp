// SPDX-License-Identifier: Apache-2.0
#include "plan/picture_limits.h"

#include <algorithm>

#include "base/error.h"

namespace lamina {

void check_limits(const Scene& scene, const Capabilities& capabilities) {
    const int edge = std::max(scene.width, scene.height);
    if (edge > capabilities.max_texture_size) {
        fail("{}: image: found {} x {} pixels, expected at most {} along an edge: {}",
             scene.file.string(), scene.width, scene.height, capabilities.max_texture_size,
             capabilities.renderer);
    }
    const std::uint64_t bytes =
        16 * static_cast<std::uint64_t>(scene.width) * static_cast<std::uint64_t>(scene.height);
    if (bytes > capabilities.max_texture_bytes) {
        fail("{}: image: found {} x {} pixels, expected at most {} in all: {}", scene.file.string(),
             scene.width, scene.height, capabilities.max_texture_bytes / 16, capabilities.renderer);
    }
}

}  // namespace lamina
