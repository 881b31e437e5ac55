// SPDX-License-Identifier: Apache-2.0
#include "plan/compositing_plan.h"

#include "base/unreachable.h"

namespace lamina {

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
