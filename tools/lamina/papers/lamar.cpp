// SPDX-License-Identifier: Apache-2.0
#include "papers/lamar.h"

#include <array>
#include <cmath>
#include <vector>

#include "papers/ramp.h"
#include "volume/generate.h"

namespace lamina::papers {

const std::vector<LamarItem>& lamar_items() {
    static const std::vector<LamarItem> items{
        {"table1", {"table1.csv"}, reproduce_table1, nullptr},
        {"table2", {"table2.csv"}, reproduce_table2, nullptr},
        {"table3", {"table3.csv"}, reproduce_table3, nullptr},
        {"table4", {"table4.csv"}, nullptr, draw_table4},
        {"figure1", {"figure1.csv"}, nullptr, draw_figure1},
        {"figure2", ramp_figure_files("figure2"), reproduce_figure2, nullptr},
        {"figure3", ramp_figure_files("figure3"), reproduce_figure3, nullptr},
        {"figure4", ramp_figure_files("figure4"), reproduce_figure4, nullptr},
        {"figure5", ramp_figure_files("figure5"), reproduce_figure5, nullptr},
        {"figure6", {}, nullptr, draw_figure6},
        {"figure9", ramp_figure_files("figure9"), reproduce_figure9, nullptr},
        {"figure10", {"figure10.csv"}, nullptr, draw_figure10},
        {"order", {"order.csv", "order.svg"}, reproduce_order, nullptr},
        {"order_mixing", {"order_mixing.csv"}, nullptr, draw_order_mixing},
        {"dithering",
         {"dithering_periods.csv", "dithering_periods.svg", "dithering_increments.csv",
          "dithering_increments.svg", "dithering_spans.csv"},
         reproduce_dithering,
         nullptr},
        {"times", {"times.csv", "times_barriers.csv", "times_palettes.csv"}, nullptr, draw_times},
    };
    return items;
}

Scene with_paper_hardware(Scene scene) {
    scene.target = Target::emulated;
    scene.emulate = Emulation{};  // 8 bits, truncate, separate
    return scene;
}

ErrorNorms channel_error(const Image& image, const Image& exact, std::size_t channel) {
    return image_error(image, exact).of_channel[channel];
}

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
