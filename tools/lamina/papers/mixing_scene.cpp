// SPDX-License-Identifier: Apache-2.0
#include "papers/mixing_scene.h"

#include <array>
#include <cmath>
#include <vector>

#include "volume/generate.h"

namespace lamina::papers {
namespace {

constexpr int depth = 1024;  // slabs
constexpr double light_density = 0.023;
constexpr double opacity_per_density = 0.765;

Scene scene_of(int pixels, bool white) {
    Scene scene;
    std::vector<TransferKnot> knots;
    for (int value = 0; value <= 255; ++value) {
        const double density = light_density + (1 - light_density) * value / 255.0;
        const glm::dvec3 color = white ? glm::dvec3(1) : glm::dvec3(density, 1 - density, 0);
        knots.push_back({double(value), {color, -std::log1p(-opacity_per_density * density)}});
    }
    scene.transfer_function = TransferFunction::linear(std::move(knots));
    scene.camera->projection = Projection::orthographic;
    scene.camera->eye = {0.5, 0.5, 2};
    scene.camera->center = glm::dvec3(0.5);
    scene.camera->height = 1;
    scene.width = scene.height = pixels;
    scene.slice.classification = Classification::post;
    scene.slice.samples = depth;
    return scene;
}

}  // namespace

Volume mixing_volume() {
    return generate({"mixing", std::array<std::int64_t, 3>{128, 128, 256}, SampleType::uint8});
}

Scene mixing_scene(int pixels) {
    return scene_of(pixels, false);
}

Scene white_mixing_scene(int pixels) {
    return scene_of(pixels, true);
}

}  // namespace lamina::papers
