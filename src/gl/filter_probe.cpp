// SPDX-License-Identifier: Apache-2.0
#include "gl/filter_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/full_screen.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace lamina::gl {
namespace {

constexpr int texels = 4;    // a side of the texture
constexpr int samples = 16;  // a side of the image

using Values = std::array<float, texels * texels * texels>;

// Scattered over [0, 1): a linear ramp would hide errors of the weights that cancel.
Values scattered_values() {
    Values values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double irrational = 0.6180339887498949 * static_cast<double>(i + 1);
        values[i] = static_cast<float>(irrational - std::floor(irrational));
    }
    return values;
}

double trilinear(const Values& values, const std::array<double, 3>& position) {
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        int index = 0;
        for (int axis = 2; axis >= 0; --axis) {
            const double below = std::floor(position[axis]);
            const double fraction = position[axis] - below;
            const int step = (corner >> axis) & 1;
            weight *= step ? fraction : 1 - fraction;
            index = index * texels + std::min(static_cast<int>(below) + step, texels - 1);
        }
        sum += weight * static_cast<double>(values[static_cast<std::size_t>(index)]);
    }
    return sum;
}

// Of fragment `index`, in texels from the centre of the first one: as in
// shaders/gl/filter_probe.frag.
std::array<double, 3> probe_position(int index) {
    return {index * 467 % 12288 / 4096.0, index * 1283 % 12288 / 4096.0,
            index * 2741 % 12288 / 4096.0};
}

}  // namespace

double measure_float_filter_error() {
    const Values values = scattered_values();
    Texture texture = Texture::make_3d(TextureFormat::r32f, texels, texels, texels);
    texture.upload({.width = texels, .height = texels, .depth = texels}, values);
    texture.set_filter(TextureFilter::linear);

    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, samples, samples));
    target.bind();
    texture.bind(0);
    Program program("gl/full_screen.vert", "gl/filter_probe.frag");
    program.set("probe", 0);
    draw_full_screen(program);

    const std::vector<float> filtered = target.color().read_rgba();
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    double error = 0;
    for (int i = 0; i < samples * samples; ++i) {
        const double exact = trilinear(values, probe_position(i));
        error = std::max(
            error,
            std::abs(static_cast<double>(filtered[4 * static_cast<std::size_t>(i)]) - exact));
    }
    return error / static_cast<double>(*most - *least);
}

}  // namespace lamina::gl
