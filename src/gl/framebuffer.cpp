// SPDX-License-Identifier: Apache-2.0
#include "gl/framebuffer.h"

#include <glad/gl.h>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"

namespace lamina::gl {

namespace {

std::vector<Texture> as_list(Texture color) {
    std::vector<Texture> colors;
    colors.push_back(std::move(color));
    return colors;
}

constexpr int texels = 4;    // texels along each side of the 3D texture
constexpr int samples = 16;  // pixels along each side of the target, with one filtered value each

template <typename Value>
using Values = std::array<Value, texels * texels * texels>;

// The values of the probed texture lie in [least, least + range); shaders read value / scale. For
// integer formats the range is small, so that rounding to codes shows beside that of weights.
struct Probe {
    double scale, least, range;
};

// Returns values in irregular order: in a linear ramp, errors of the weights would cancel.
template <typename Value>
Values<Value> scattered_values(const Probe& probe) {
    Values<Value> values;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double irrational = 0.6180339887498949 * static_cast<double>(i + 1);
        values[i] =
            static_cast<Value>(probe.least + probe.range * (irrational - std::floor(irrational)));
    }
    return values;
}

template <typename Value>
double trilinear(const Values<Value>& values, const std::array<double, 3>& position,
                 bool eight_bit_weights) {
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        int index = 0;
        for (int axis = 2; axis >= 0; --axis) {
            const double below = std::floor(position[axis]);
            const double share = position[axis] - below;
            const double fraction = eight_bit_weights ? std::round(256 * share) / 256 : share;
            const int step = (corner >> axis) & 1;
            weight *= step ? fraction : 1 - fraction;
            index = index * texels + std::min(static_cast<int>(below) + step, texels - 1);
        }
        sum += weight * static_cast<double>(values[static_cast<std::size_t>(index)]);
    }
    return sum;
}

// Returns the position at which fragment `index` filters, in texels from the centre of the first
// texel, as shaders/gl/filter_probe.frag computes it.
std::array<double, 3> probe_position(int index) {
    return {index * 467 % 12288 / 4096.0, index * 1283 % 12288 / 4096.0,
            index * 2741 % 12288 / 4096.0};
}

// Draws filtered values at scattered positions and compares them with exact interpolation, as it
// does interpolation with weights rounded to 8 bits.
template <typename Value>
FilterError measure(TextureFormat format, const Probe& probe) {
    const Values<Value> values = scattered_values<Value>(probe);
    Texture texture = Texture::make_3d(format, texels, texels, texels);
    texture.upload({.width = texels, .height = texels, .depth = texels},
                   std::span<const Value>(values));
    texture.set_filter(TextureFilter::linear);

    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, samples, samples));
    target.bind();
    texture.bind(0);
    Program program("gl/full_screen.vert", "gl/filter_probe.frag");
    program.set("probe", 0);
    draw_full_screen(program);

    const std::vector<float> filtered = target.color().read_rgba();
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double range = static_cast<double>(*most) - static_cast<double>(*least);
    FilterError error;
    for (int i = 0; i < samples * samples; ++i) {
        const std::array<double, 3> place = probe_position(i);
        const double exact = trilinear(values, place, false);
        const double found = probe.scale * filtered[4 * static_cast<std::size_t>(i)];
        error.found = std::max(error.found, std::abs(found - exact) / range);
        error.eight_bit =
            std::max(error.eight_bit, std::abs(trilinear(values, place, true) - exact) / range);
    }
    return error;
}

}  // namespace

Framebuffer::Framebuffer(Texture color) : Framebuffer(as_list(std::move(color))) {}

Framebuffer::Framebuffer(std::vector<Texture> colors)
    : colors_(std::move(colors)), handle_(new_object(ObjectKind::framebuffer)) {
    assert(!colors_.empty());
    std::vector<GLenum> outputs;
    for (const Texture& color : colors_) {
        assert(color.width() == width() && color.height() == height() && color.depth() == 1);
        outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size()));
        api().NamedFramebufferTexture(id(), outputs.back(), color.id(), 0);
    }
    api().NamedFramebufferDrawBuffers(id(), static_cast<GLsizei>(outputs.size()), outputs.data());
    const GLenum status = api().CheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        fail("OpenGL cannot draw into {} {} textures of {} x {} (framebuffer status {:#x})",
             colors_.size(), info_of(color().format()).name, width(), height(), status);
    }
    check("making a framebuffer");
}

void Framebuffer::bind() const {
    api().BindFramebuffer(GL_FRAMEBUFFER, id());
    api().Viewport(0, 0, width(), height());
}

void Framebuffer::clear(const glm::vec4& rgba, std::size_t target) {
    api().ClearNamedFramebufferfv(id(), GL_COLOR, static_cast<GLint>(target), &rgba.x);
}

Image Framebuffer::read_back(std::size_t target) const {
    Image image;
    read_back(image, target);
    return image;
}

void Framebuffer::read_back(Image& image, std::size_t target) const {
    const std::size_t row = 4 * static_cast<std::size_t>(width());
    const int at_once = ReadBack::rows_at_once(row * sizeof(float));
    for (int first = 0; first < height(); first += at_once) {
        const int rows = std::min(at_once, height() - first);
        reading_.take(color(target), first, rows);
        image.resize(width(), height());
        const std::span<const float> rgba = reading_.values<float>();
        parallel_for(rows, 16, [&](std::int64_t y) {
            std::ranges::copy(rgba.subspan(static_cast<std::size_t>(y) * row, row),
                              image.pixel(0, height() - 1 - first - static_cast<int>(y)));
        });
    }
}

void draw_full_screen(const Program& program) {
    draw_full_screen(program, VertexArray());
}

void draw_full_screen(const Program& program, const VertexArray& any) {
    any.bind();
    program.use();
    api().DrawArrays(GL_TRIANGLES, 0, 3);
    check("drawing over the whole target");
}

FilterError measure_filter_error(TextureFormat format) {
    switch (format) {
        case TextureFormat::r8:
            return measure<std::uint8_t>(format, {.scale = 255, .least = 96, .range = 8});
        case TextureFormat::r16:
            return measure<std::uint16_t>(format, {.scale = 65535, .least = 32768, .range = 256});
        default:  // callers pass no other format
            assert(format == TextureFormat::r32f);
            return measure<float>(TextureFormat::r32f, {.scale = 1, .least = 0, .range = 1});
    }
}

}  // namespace lamina::gl
