// SPDX-License-Identifier: Apache-2.0
#include "study/drawn_scene.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/atomic_file.h"
#include "image/png.h"
#include "slicing/gl_slice_renderer.h"

namespace lamina {

DrawnVolume::DrawnVolume(Volume volume)
    : volume_(std::move(volume)), bricks_(measure_bricks(volume_)) {}

Facts DrawnVolume::measure_for(const Scene& scene) const {
    return measure(scene, volume_, bricks_);
}

Image DrawnVolume::draw(const Scene& scene, const Capabilities& capabilities) const {
    const Facts facts = measure_for(scene);
    const Plan plan = make_plan(scene, facts, capabilities, {});
    GlSliceRenderer renderer(volume_, scene.transfer_function, facts, plan.slice, capabilities,
                             scene.width, scene.height);
    renderer.draw(View(scene.camera, scene.width, scene.height));
    return renderer.read();
}

Scene with_paper_hardware(Scene scene) {
    scene.target = Target::emulated;
    scene.emulate = Emulation{};  // 8 bits, truncate, separate
    return scene;
}

ErrorNorms channel_error(const Image& image, const Image& exact, std::size_t channel) {
    return image_error(image, exact).of_channel[channel];
}

void write_pictures(const std::filesystem::path& path, const std::vector<Image>& pictures) {
    constexpr int gap = 4;
    const int width = pictures.front().width, height = pictures.front().height;
    const int count = static_cast<int>(pictures.size());
    Image all(count * (width + gap) - gap, height);
    std::fill(all.rgba.begin(), all.rgba.end(), 1.0f);
    for (int i = 0; i < count; ++i) {
        const Image& picture = pictures[static_cast<std::size_t>(i)];
        assert(picture.width == width && picture.height == height);
        for (int row = 0; row < height; ++row) {
            std::copy_n(picture.pixel(0, row), 4 * width, all.pixel(i * (width + gap), row));
        }
    }
    AtomicFile png(path);
    write_png(png, all, glm::dvec3(0));
    png.commit();
}

}  // namespace lamina
