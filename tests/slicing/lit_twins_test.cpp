// SPDX-License-Identifier: Apache-2.0
// Light in shaders, and the gradients from which it is computed, are equal to those of the twins in
// C++.
#include <cmath>
#include <glm/geometric.hpp>

#include "executors/gl_optics.h"
#include "executors/lights.h"
#include "gl/framebuffer.h"
#include "optics/ray_lights.h"
#include "plan/planners.h"
#include "reference/cells.h"
#include "reference/lit_fixtures.h"
#include "slicing/gl_slab_source.h"
#include "slicing/gradient_map.h"
#include "slicing/slab_geometry.h"
#include "slicing_fixture.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

using reference_test::Random;

constexpr int lit_edge = 128;

// Returns the pixels that a program draws, row 0 at the bottom.
std::vector<float> drawn_pixels(gl::Program& program) {
    gl::Framebuffer target(gl::Texture::make_2d(gl::TextureFormat::rgba32f, lit_edge, lit_edge));
    target.bind();
    gl::draw_full_screen(program);
    return target.color().read_rgba();
}

TEST(StoredGradients, KeepDirectionAndLengthOfAllSizes) {
    Random random(3);
    for (int i = 0; i < 10000; ++i) {
        const double length = std::exp(random.uniform(-600, 600));
        const glm::dvec3 gradient = length * random.point(-1, 1);
        const StoredGradient stored = store_gradient({gradient.x, gradient.y, gradient.z});
        const double largest =
            std::max({std::abs(gradient.x), std::abs(gradient.y), std::abs(gradient.z)});
        for (int axis = 0; axis < 3; ++axis) {
            const double component = stored.component[static_cast<std::size_t>(axis)];
            EXPECT_NEAR(std::ldexp(component, stored.exponent), gradient[axis], 0x1p-15 * largest);
        }
    }
    EXPECT_EQ(store_gradient({0, 0, 0}), StoredGradient{});
    EXPECT_EQ(store_gradient({0, -0x1p100, 0}), (StoredGradient{{0, -0x4000, 0}, 86}));
}

// Returns a random direction to the eye. No light is nearly opposite to it, because roundings are
// large there.
glm::dvec3 eye_for(const Lighting& lighting, Random& random) {
    while (true) {
        const glm::dvec3 eye = glm::normalize(random.point(-1, 1));
        bool serves = true;
        for (const Light& light : lighting.lights) {
            if (light.direction)
                serves = serves && glm::dot(glm::normalize(*light.direction), eye) > -.5;
        }
        if (serves) return eye;
    }
}

void compare_light(const Lighting& lighting, const glm::dvec3& eye, Random& random) {
    // Rotated axes of any length, along which the program's gradients are given.
    const std::array<glm::dvec3, 3> axes{glm::dvec3(2, 1, 2), glm::dvec3(-2, 2, 1) * .1,
                                         glm::dvec3(1, 2, -2)};
    std::vector<float> gradients;
    for (int i = 0; i < lit_edge * lit_edge; ++i) {
        const double length = *lighting.smallest_gradient * std::exp(random.uniform(-7, 12));
        const glm::dvec3 gradient = length * random.point(-1, 1);
        for (int axis = 0; axis < 3; ++axis)
            gradients.push_back(static_cast<float>(gradient[axis]));
        gradients.push_back(0);
    }
    for (std::size_t i = 0; i < 3; ++i) gradients[i] = 0;
    gl::Texture texture = gl::Texture::make_2d(gl::TextureFormat::rgba32f, lit_edge, lit_edge);
    texture.upload({0, 0, 0, lit_edge, lit_edge, 1}, std::span<const float>(gradients));
    texture.bind(0);
    gl::Defines defines;
    set_light_defines(lighting, defines);
    gl::Program program = gl::full_screen_program(
        "#version 450 core\n"
        "#include \"optics/lighting.glsl\"\n"
        "uniform sampler2D points;\n"
        "uniform vec3 to_eye;\n"
        "uniform float smallest_square;\n"
        "out vec4 result;\n"
        "void main() {\n"
        "    vec3 gradient = texelFetch(points, ivec2(gl_FragCoord.xy), 0).rgb;\n"
        "    LightEffect effect = light_effect(gradient, smallest_square, to_eye);\n"
        "    result = vec4(vec3(.75, .5, .25) * effect.change + effect.highlight, 1.0);\n"
        "}\n",
        defines);
    set_lights(lighting, axes, program);
    program.set("points", 0);
    const auto along_axes = [&](const glm::dvec3& v) {
        return glm::dvec3(glm::dot(v, unit_vector(axes[0])), glm::dot(v, unit_vector(axes[1])),
                          glm::dot(v, unit_vector(axes[2])));
    };
    program.set("to_eye", glm::vec3(along_axes(eye)));
    const double smallest = *lighting.smallest_gradient;
    program.set("smallest_square", static_cast<float>(smallest * smallest));
    const std::vector<float> pixels = drawn_pixels(program);
    const RayLights lights(lighting, eye);
    // A cosine is a sum of three products, with some five roundings of 2^-24. That with the halfway
    // vector has half as many more, as |l + v| is at least 1. pow() is off by 2^-21 in the
    // logarithm (GLSL 4.60, section 4.7.1), which half_power multiplies.
    const double cosine = 8 * 0x1p-24;
    const double terms = lights.largest_effect(1) + lighting.diffuse + lighting.specular;
    const double error = 3 * terms * (cosine + lighting.power * (cosine + .5 * 0x1p-21));
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        const glm::dvec3 stored(gradients[i], gradients[i + 1], gradients[i + 2]);
        const glm::dvec3 gradient = stored.x * unit_vector(axes[0]) +
                                    stored.y * unit_vector(axes[1]) +
                                    stored.z * unit_vector(axes[2]);
        const glm::dvec3 expected = lights.effect(gradient).on({.75, .5, .25});
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(pixels[i + static_cast<std::size_t>(c)], expected[c], error) << i;
    }
}

TEST_F(SlicingTest, LightInShadersMatchesCpp) {
    Random random(7);
    for (int i = 0; i < 30; ++i) {
        const Lighting lighting = reference_test::random_lighting(random);
        compare_light(lighting, eye_for(lighting, random), random);
    }
    Lighting all = reference_test::directional();
    all.lights.resize(Lighting::most_lights, {glm::dvec3(1, 1, 1), {.2, .1, .3}});
    compare_light(all, eye_for(all, random), random);
    // A light opposite to the eye makes no highlight.
    Lighting behind;
    behind.smallest_gradient = .1;
    behind.lights = {{glm::dvec3(-3, 1, 2), glm::dvec3(1)}};
    compare_light(behind, glm::normalize(glm::dvec3(3, -1, -2)), random);
}

// Returns a program that draws the gradient in the middle of a part of a ray in a cell, divided by
// the smallest gradient. Parts begin at multiples of 1/16 and extend by half a cell on each axis.
gl::Program gradient_program() {
    return gl::full_screen_program(
        "#version 450 core\n"
        "#include \"slicing/cell_gradient.glsl\"\n"
        "uniform ivec3 first_cell;\n"
        "uniform ivec3 cells;\n"
        "out vec4 result;\n"
        "void main() {\n"
        "    int i = int(gl_FragCoord.x) + 128 * int(gl_FragCoord.y);\n"
        "    ivec3 cell = first_cell + ivec3(i, i / cells.x, i / (cells.x * cells.y)) % cells;\n"
        "    vec3 place = vec3(ivec3(i, i / 3, i / 7) % 9) / 16.0;\n"
        "    CellGradient gradient = cell_gradient(cell, place, vec3(0.5));\n"
        "    result = vec4(gradient_along(gradient, 0.5) / sqrt(gradient.smallest_square), 1.0);\n"
        "}\n");
}

template <typename Sample>
void compare_brick(const Volume& volume, const TextureBrick& brick, gl::Program& program,
                   double smallest) {
    const Grid& grid = volume.grid();
    const IndexBox box = box_of(brick, grid);
    glm::ivec3 first, cells;
    for (int axis = 0; axis < 3; ++axis) {
        first[axis] = static_cast<int>(std::floor(box.min[axis]));
        cells[axis] = std::max(static_cast<int>(std::ceil(box.max[axis])) - first[axis], 1);
    }
    const glm::ivec3 origin(brick.first[0], brick.first[1], brick.first[2]);
    program.set("first_cell", first - origin);
    program.set("cells", cells);
    program.set("last_sample",
                glm::vec3(glm::dvec3(brick.size[0], brick.size[1], brick.size[2]) - 1.0));
    const std::vector<float> pixels = drawn_pixels(program);
    const GradientSamples samples(grid, static_cast<const Sample*>(volume.data()));
    for (int i = 0; i < lit_edge * lit_edge; ++i) {
        const CellIndex cell{first.x + i % cells.x, first.y + i / cells.x % cells.y,
                             first.z + i / (cells.x * cells.y) % cells.z};
        const auto at = [&](const glm::dvec3& place) {
            const GradientAlong along = samples.along(cell, place, glm::dvec3(0));
            const glm::dvec3 world(along[0](0), along[1](0), along[2](0));
            glm::dvec3 gradient;
            for (int axis = 0; axis < 3; ++axis)
                gradient[axis] =
                    glm::dot(world, glm::normalize(grid.step[static_cast<std::size_t>(axis)]));
            return gradient / smallest;
        };
        double steepest = 0;
        for (int corner = 0; corner < 8; ++corner)
            steepest =
                std::max(steepest, glm::length(at({corner & 1, corner >> 1 & 1, corner >> 2 & 1})));
        const glm::dvec3 expected =
            at((glm::dvec3(i % 9, i / 3 % 9, i / 7 % 9) / 16.) + glm::dvec3(.25));
        // 2^-15 of each corner's gradient, and some ten roundings of float32.
        const double error = (0x1p-15 + 0x1p-20) * steepest;
        if (!std::isfinite(glm::dot(expected, expected))) continue;  // beside a NaN sample
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(pixels[static_cast<std::size_t>(4 * i + axis)], expected[axis], error)
                << cell[0] << " " << cell[1] << " " << cell[2];
    }
}

template <typename Sample>
void compare_gradients(const Volume& volume, bool bordered, std::uint64_t brick_bytes,
                       double smallest) {
    Capabilities small;
    small.max_3d_texture_size = 2048;
    small.max_texture_bytes = brick_bytes;
    SlicePlan plan;
    plan.classification = Classification::exact;
    plan.float_texture = volume.type() == SampleType::float32;
    plan.bricks = cut_into_bricks(volume.grid(), bordered, sizeof(StoredGradient), small);
    plan.lighting.emplace().smallest_gradient = smallest;
    const GlVolume textures(volume, {0, 1}, plan);
    ASSERT_EQ(textures.gradients().size(), plan.bricks.size());
    gl::Program program = gradient_program();
    const SmallestGradient parts = smallest_gradient_of(*plan.lighting);
    program.set("smallest_gradient", parts.mantissa);
    program.set("smallest_exponent", parts.exponent);
    program.set("gradients", 0);
    for (std::size_t i = 0; i < plan.bricks.size(); ++i) {
        textures.gradients()[i].bind(0);
        compare_brick<Sample>(volume, plan.bricks[i], program, smallest);
    }
}

Grid turned(Centering centering) {
    Grid grid = test::grid_of({13, 8, 9}, centering);
    grid.step = {glm::dvec3(2, 1, 2) * .25, glm::dvec3(-2, 2, 1) * .5, glm::dvec3(1, 2, -2) * .3};
    return grid;
}

TEST_F(SlicingTest, GradientsOfCellsMatchThoseOfTheSamples) {
    constexpr std::uint64_t whole = 1 << 20, parts = 8 * 150;
    const Volume bytes =
        test::volume_of<std::uint8_t>(turned(Centering::cell), [](double x, double y, double z) {
            return 128 + 100 * std::sin(x * y + 3 * z) * std::cos(x - 2 * y);
        });
    // Includes fill values of several sizes, and NaN.
    const Volume floats =
        test::volume_of<float>(turned(Centering::cell), [](double x, double y, double z) {
            const int i = static_cast<int>(x + 5 * y + 11 * z) % 29;
            if (i == 0) return 1e9;
            if (i == 9) return -1e20;
            if (i == 17) return 1e32;
            return i == 25 ? double{NAN} : std::sin(x * y + 3 * z);
        });
    for (const std::uint64_t size : {whole, parts}) {
        compare_gradients<std::uint8_t>(bytes, false, size, 3);
        compare_gradients<float>(floats, false, size, 1);
        compare_gradients<float>(floats, true, size, 1);
    }
    // A smallest gradient that float32 cannot hold.
    compare_gradients<float>(test::volume_of<float>(turned(Centering::node),
                                                    [](double x, double y, double z) {
                                                        return 1e-37 * std::sin(x * y + 3 * z);
                                                    }),
                             false, parts, 1e-45);
}

}  // namespace
}  // namespace lamina
