// SPDX-License-Identifier: Apache-2.0
// Functions that exist both in GLSL and in C++ give the same numbers.

#include "gl/framebuffer.h"
#include "optics/opacity.h"
#include "slicing_fixture.h"

namespace lamina {
namespace {

constexpr int edge = 128;

Image drawn_image(gl::Program& program) {
    gl::Framebuffer target(gl::Texture::make_2d(gl::TextureFormat::rgba32f, edge, edge));
    target.bind();
    gl::draw_full_screen(program);
    return target.read_back();
}

TEST_F(SlicingTest, OpacityFromDepthInShadersMatchesCppToFloat32) {
    gl::Program program = gl::full_screen_program(
        "#version 450 core\n"
        "#include \"optics/opacity.glsl\"\n"
        "out vec4 result;\n"
        "void main() {\n"
        "    vec2 pixel = floor(gl_FragCoord.xy);\n"
        "    float depth = exp2((pixel.x + 128.0 * pixel.y) * (33.0 / 16384.0) - 27.0);\n"
        "    result = vec4(depth, opacity_from_depth(depth), 0.0, 1.0);\n"
        "}\n");
    const Image image = drawn_image(program);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {  // depths from 7e-9 to 64
        const double expected = opacity_from_depth(image.rgba[i]);
        // The relative error is at most 3e-7 (shaders/optics/opacity.glsl), and a rounding of the
        // result. The absolute error allowed above 1/4 is that of 1 - exp(-x) with an exp() that is
        // off by 4 units of 2^-24; the present shader stays far below it.
        const double relative = expected * 4e-7, absolute = image.rgba[i] < .25f ? 0 : 4 * 0x1p-24;
        EXPECT_NEAR(image.rgba[i + 1], expected, relative + absolute) << image.rgba[i];
    }
}

// Compares integrate_run() of knot_table.glsl with KnotTable, for all front scalars (by column) and
// back scalars (by row), over a transfer function with a ramp, a peak and a step. `lit`: compares
// the front parts.
void compare_runs(bool colored, int layers, bool filtered, bool lit = false) {
    const glm::dvec3 grey(.6, .6, .6);
    const auto color = [&](const glm::dvec3& other) { return colored ? other : grey; };
    const TransferFunction transfer_function = TransferFunction::linear(
        {knot(0, color({0, 0, 1}), 0), knot(.3, color({0, 1, 0}), 1),
         knot(.31, color({1, 1, 0}), 30), knot(.32, color({1, 0, 0}), 1),
         knot(.7, color({.2, .4, .8}), 2), knot(.7, color({1, .5, 0}), 6)});
    SlicePlan plan;
    plan.classification = Classification::preintegrated;
    plan.single_color = !colored;
    plan.table_filtered = filtered;
    plan.table.request = {0, 1, 1.0, 256, layers, colored, lit};
    const KnotTable table(transfer_function, plan.table.request);
    const GlTransferTables tables(transfer_function, {0, 1}, &table, filtered, 0, false);
    gl::Program program = gl::full_screen_program(
        "#version 450 core\n"
        "#include \"preintegration/knot_table.glsl\"\n"
        "uniform float world_length;\n"
        "out vec4 result;\n"
        "void main() {\n"
        "    RunSum sum = integrate_run(gl_FragCoord.x / 128.0, gl_FragCoord.y / 128.0, "
        "world_length, "
        "false);\n"
        "    result = sum.whole;\n"
        "#ifdef TABLE_LIT\n"
        "    result = sum.front;\n"
        "#endif\n"
        "}\n",
        segment_defines(plan, tables.intervals(), tables.nodes(), false));
    tables.bind(program);
    program.set("world_length", .35f);
    const Image image = drawn_image(program);
    for (int row = 0; row < edge; ++row) {
        for (int column = 0; column < edge; ++column) {
            const double front = (column + .5) / edge, back = (edge - row - .5) / edge;
            const LitIntegral both = table.lookup_lit(front, back, .35f);
            const SegmentIntegral& expected = both.whole;
            const float* const pixel = image.pixel(column, row);
            // Node coordinates near 300 in float32 are good to 3e-5 of a cell, over which
            // extinction changes by at most 30 / 3 (the peak has few nodes). That is 3e-4 of
            // optical depth per world length, and about as much for the ends of the pieces.
            EXPECT_NEAR(pixel[3], lit ? both.front.alpha : expected.optical_depth, 3e-4)
                << front << " " << back;
            if (!colored) continue;
            const glm::dvec3& color_there = lit ? both.front.color : expected.color;
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(pixel[channel], color_there[channel], 3e-4) << front << " " << back;
        }
    }
}

TEST_F(SlicingTest, PreintegratedSegmentsInShadersMatchCpp) {
    for (const bool filtered : {false, true}) {
        compare_runs(true, 1, filtered, true);
        compare_runs(true, 5, filtered, true);
        compare_runs(false, 1, filtered);
        compare_runs(true, 1, filtered);
        compare_runs(true, 5, filtered);
    }
}

}  // namespace
}  // namespace lamina
