// SPDX-License-Identifier: Apache-2.0
// Functions that draw a scene with the cpu engine.
#pragma once

#include "slicing/slice_renderer.h"
#include "slicing_fixture.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {

inline std::unique_ptr<CpuSliceRenderer> cpu_renderer(
    const Volume& volume, const Scene& scene, const OmissionSwitch& omissions = {},
    const Capabilities& capabilities = cpu_capabilities()) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const Plan plan = make_plan(scene, facts, capabilities, omissions);
    return std::make_unique<CpuSliceRenderer>(volume, *scene.transfer_function, facts, plan.slice,
                                              scene.width, scene.height);
}

inline Image render_tiles(const Volume& volume, const Scene& scene,
                          const OmissionSwitch& omissions = {},
                          const Capabilities& capabilities = cpu_capabilities()) {
    const auto renderer = cpu_renderer(volume, scene, omissions, capabilities);
    renderer->draw(View(*scene.camera, scene.width, scene.height));
    return renderer->read();
}

}  // namespace lamina
