// SPDX-License-Identifier: Apache-2.0
#include "plan/compositing_plan.h"

#include <algorithm>

#include "base/enum_words.h"
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

Blending programmable_blending(const Capabilities& capabilities) {
    if (capabilities.tiles) return Blending::tiles;
    return capabilities.framebuffer_fetch ? Blending::fetch : Blending::barrier;
}

const char* name_of(Blending blending) {
    switch (blending) {
        case Blending::native:
            return "blending_unit";
        case Blending::fetch:
            return "framebuffer_fetch";
        case Blending::barrier:
            return "texture_barrier";
        case Blending::tiles:
            return "tiles";
    }
    unreachable_enum();
}

Dither dither_of(const DitherSettings& settings, int slabs) {
    return {settings.period.value_or(dither_period_for(slabs)), settings.seed, settings.color,
            settings.increment};
}

}  // namespace lamina
