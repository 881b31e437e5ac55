// SPDX-License-Identifier: Apache-2.0
#include "study/drawn_scene.h"

#include <utility>

#include "slicing/slab_trials.h"
#include "slicing/slice_renderer.h"

namespace lamina {

DrawnVolume::DrawnVolume(Volume volume)
    : volume_(std::move(volume)), bricks_(measure_bricks(volume_)) {}

Facts DrawnVolume::measure_for(const Scene& scene, const Capabilities& capabilities) const {
    Facts facts = measure_slicing(scene, volume_, bricks_);
    try_filter(scene, volume_, capabilities, facts);
    return facts;
}

Image DrawnVolume::draw(const Scene& scene, const Capabilities& capabilities) const {
    const Facts facts = measure_for(scene, capabilities);
    const Plan plan = make_plan(scene, facts, capabilities, {});
    const auto renderer = make_slice_renderer(volume_, scene.transfer_function, facts, plan.slice,
                                              capabilities, scene.width, scene.height);
    renderer->draw(View(scene.camera, scene.width, scene.height));
    return renderer->read();
}

Scene with_paper_hardware(Scene scene) {
    scene.target = Target::emulated;
    scene.emulate = Emulation{};  // 8 bits, truncate, separate
    return scene;
}

ErrorNorms channel_error(const Image& image, const Image& exact, std::size_t channel) {
    return image_error(image, exact).of_channel[channel];
}

}  // namespace lamina
