// SPDX-License-Identifier: Apache-2.0
// GLSL integrates a fragment's segment with the numbers of its twins in optics/ and
// preintegration/.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "executors/transfer_tables.h"
#include "gl/framebuffer.h"
#include "gl/gl_fixture.h"
#include "gl/texture.h"
#include "lamina/image.h"
#include "optics/opacity.h"
#include "optics/segment_integral.h"
#include "preintegration/preintegration_table.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

constexpr int edge = 128;

using SegmentTwins = gl::GlTest;

using test::knot;

Image run(gl::Program& program) {
    gl::Framebuffer target(gl::Texture::make_2d(gl::TextureFormat::rgba32f, edge, edge));
    target.bind();
    gl::draw_full_screen(program);
    return target.read_back();
}

// The scalars of a pixel's segment, at the front (by column) and at the back (by row), exact in
// float32.
struct Scalars {
    double front, back;
};
Scalars scalars_of(int column, int row) {
    return {(column + .5) / edge, (edge - row - .5) / edge};
}

gl::Program integrating_program(const std::string& file, const gl::Defines& defines) {
    return gl::full_screen_program("#version 450 core\n#include \"" + file +
                                       "\"\n"
                                       "uniform float world_length;\n"
                                       "out vec4 result;\n"
                                       "void main() { result = integrate_segment(gl_FragCoord.x / "
                                       "128.0, gl_FragCoord.y / 128.0, world_length); }\n",
                                   defines);
}

// --- tables ---

struct TableCase {
    TableRequest request;
    bool filtered;

    std::string name() const {
        return "colored " + std::to_string(request.colored) + ", layers " +
               std::to_string(request.length_layers) + ", mapping " +
               std::to_string(static_cast<int>(request.mapping)) + ", store " +
               std::to_string(static_cast<int>(request.store)) + ", format " +
               std::to_string(static_cast<int>(request.format)) + ", filtered " +
               std::to_string(filtered);
    }
};

template <typename Code>
std::vector<Code> codes_of(const std::vector<float>& texels) {
    std::vector<Code> codes;
    for (const float texel : texels) {
        codes.push_back(static_cast<Code>(std::lround(texel * std::numeric_limits<Code>::max())));
    }
    return codes;
}

gl::Texture upload(const UniformTable& table, bool filtered) {
    using gl::TextureFormat;
    const bool color = table.channels == 4;
    TextureFormat format = color ? TextureFormat::rgba32f : TextureFormat::r32f;
    if (table.request.format == TableFormat::fixed16)
        format = color ? TextureFormat::rgba16 : TextureFormat::r16;
    if (table.request.format == TableFormat::float16)
        format = color ? TextureFormat::rgba16f : TextureFormat::r16f;
    const int nodes = table.request.scalar_nodes, layers = table.layers;
    gl::Texture texture = layers > 1 ? gl::Texture::make_3d(format, nodes, nodes, layers)
                                     : gl::Texture::make_2d(format, nodes, nodes);
    const gl::TexelBox whole{0, 0, 0, nodes, nodes, layers};
    if (table.request.format == TableFormat::fixed16) {
        texture.upload(whole,
                       std::span<const std::uint16_t>(codes_of<std::uint16_t>(table.texels)));
    } else {
        texture.upload(whole, std::span<const float>(table.texels));
    }
    if (filtered) texture.set_filter(gl::TextureFilter::linear);
    return texture;
}

void compare_table(const TableCase& wanted) {
    SCOPED_TRACE(wanted.name());
    const bool colored = wanted.request.colored;
    const glm::dvec3 grey(.75, .5, .25);
    const auto color = [&](const glm::dvec3& other) { return colored ? other : grey; };
    const TransferFunction transfer_function = TransferFunction::linear(
        {knot(-1, color({0, 0, 1}), 0), knot(-.4, color({0, 1, 0}), 1),
         knot(.4, color({.2, .4, .8}), 2), knot(.4, color({1, .5, 0}), 6)});
    const UniformTable table(transfer_function, wanted.request);
    const gl::Texture texture = upload(table, wanted.filtered);
    gl::Defines defines;
    defines.set("TABLE_NODES", wanted.request.scalar_nodes)
        .set("TABLE_LAYERS", table.layers)
        .set("TABLE_MAPPING", static_cast<int>(wanted.request.mapping))
        .set("TABLE_STORE", static_cast<int>(wanted.request.store));
    if (colored) defines.set("TABLE_COLORED", "");
    if (wanted.filtered) defines.set("TABLE_FILTERED", "");
    gl::Program program = integrating_program("preintegration/uniform_table.glsl", defines);
    texture.bind(0);
    program.set("uniform_table", 0);
    program.set("table_scale", table.scale);
    program.set("single_color", glm::vec3(grey));
    program.set("inverse_first_length", static_cast<float>(table.inverse_first_length()));
    const double max_length = wanted.request.max_length;
    for (const double share : {0.0, .003, .07, .3, .5, .9, 1.0, 1.5}) {
        const auto length = static_cast<float>(share * max_length);
        program.set("world_length", length);
        const Image image = run(program);
        double worst = 0;
        for (int row = 0; row < edge; ++row) {
            for (int column = 0; column < edge; ++column) {
                const auto [front, back] = scalars_of(column, row);
                const SegmentIntegral expected =
                    table.lookup(-1 + 2 * front, -1 + 2 * back, length);
                const float* const pixel = image.pixel(column, row);
                worst = std::max(worst, std::abs(pixel[3] - expected.alpha));
                for (int channel = 0; channel < 3; ++channel) {
                    worst = std::max(worst, std::abs(pixel[channel] - expected.color[channel]));
                }
            }
        }
        // Node coordinates near 64 in float32 are good to 4e-6 of a cell, over which alpha changes
        // by at most 1, at the step, and the layer's coordinate is good to 1e-6; all else is
        // rounding.
        EXPECT_LE(worst, 1e-5) << "length " << length;
    }
}

TEST_F(SegmentTwins, TablesMatchTheirLookUpInCpp) {
    TableCase wanted;
    wanted.request.kind = TableKind::uniform;
    wanted.request.lo = -1;
    wanted.request.hi = 1;
    wanted.request.max_length = 3;
    wanted.request.scalar_nodes = 64;
    for (const bool colored : {true, false}) {
        for (const TableStore store : {TableStore::mean_extinction, TableStore::opacity}) {
            wanted.request.colored = colored;
            wanted.request.store = store;
            wanted.request.format = TableFormat::float32;
            for (const int layers : {1, 2, 6}) {
                wanted.request.length_layers = layers;
                for (const LengthMapping mapping :
                     {LengthMapping::octave, LengthMapping::log2, LengthMapping::linear}) {
                    if (layers < 6 && mapping != LengthMapping::octave) continue;
                    wanted.request.mapping = mapping;
                    for (const bool filtered : {false, true}) {
                        wanted.filtered = filtered;
                        compare_table(wanted);
                    }
                }
            }
            wanted.request.mapping = LengthMapping::octave;
            wanted.filtered = true;
            for (const TableFormat format : {TableFormat::fixed16, TableFormat::float16}) {
                wanted.request.format = format;
                compare_table(wanted);
            }
        }
    }
}

// --- one piece ---

TEST_F(SegmentTwins, FrontWeightsMatchPieceWeightsInCpp) {
    gl::Program program = gl::full_screen_program(
        "#version 450 core\n"
        "#include \"optics/piece_weights.glsl\"\n"
        "out vec4 result;\n"
        "float depth_at(float place) {  // 0, then from 1e-12 to 1e30, most of them around 1\n"
        "    float x = place * 2.0 / 127.0 - 1.0;\n"
        "    return place == 0.0 ? 0.0 : exp2(x < 0.0 ? 40.0 * x * x * x : 99.0 * x * x * x);\n"
        "}\n"
        "void main() {\n"
        "    vec2 pixel = floor(gl_FragCoord.xy);\n"
        "    float p = depth_at(pixel.x), q = depth_at(pixel.y);\n"
        "    result = vec4(p, q, front_weight(p, q), opacity_from_depth(0.5 * p + 0.5 * q));\n"
        "}\n");
    const Image image = run(program);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const double p = image.rgba[i], q = image.rgba[i + 1];
        const double front = image.rgba[i + 2], back = image.rgba[i + 3] - front;
        const PieceWeights expected = piece_weights(p, q);
        // The bound is 2e-6 of the quadrature rule (measured in double precision over 300 x 61
        // pieces, the worst one at q = 0 and depth 12) and a few float32 roundings of numbers up to
        // 1.
        EXPECT_NEAR(front, expected.front, 3e-6) << p << " " << q;
        EXPECT_NEAR(back, expected.back, 3e-6) << p << " " << q;
        if (p + q > 2) continue;
        // For such depths the rule is exact to 2e-10 of the result. Opacities are good to 4e-7,
        // each; back is the difference of two numbers up to 3.7 and 2.7 times as large.
        EXPECT_NEAR(front, expected.front, 1e-6 * expected.front) << p << " " << q;
        EXPECT_NEAR(back, expected.back, 3e-6 * expected.back) << p << " " << q;
    }
}

TEST_F(SegmentTwins, LinearSegmentsLookUpFrontWeights) {
    constexpr int nodes = FrontWeightTable::nodes;
    gl::Texture weights = gl::Texture::make_2d(gl::TextureFormat::r32f, nodes, nodes);
    weights.upload({0, 0, 0, nodes, nodes, 1},
                   std::span<const float>(FrontWeightTable::get().texels()));
    for (const auto& [filtered, thin] : {std::pair(false, false), {true, false}, {true, true}}) {
        weights.set_filter(filtered ? gl::TextureFilter::linear : gl::TextureFilter::nearest);
        gl::Defines defines;
        defines.set("TABLE_COLORED", "").set("FRONT_WEIGHT_NODES", nodes);
        if (filtered) defines.set("TABLE_FILTERED", "");
        if (thin) defines.set("THIN", "");
        gl::Program program = gl::full_screen_program(
            "#version 450 core\n"
            "#include \"optics/linear_segment.glsl\"\n"
            "out vec4 result;\n"
            "float extinction_at(float place) { return exp2(place * 0.25 - 20.0); }\n"
            "void main() {\n"
            "    vec2 pixel = floor(gl_FragCoord.xy);\n"
            "    float p = extinction_at(pixel.x), q = extinction_at(pixel.y);\n"
            "    vec4 sum = integrate_linear(vec4(1, 0, 0, p), vec4(0, 1, 0, q), 2.0);\n"
            "    result = vec4(p, q, sum.rg);\n"
            "}\n",
            defines);
        weights.bind(0);
        if (!thin) program.set("front_weights", 0);
        const Image image = run(program);
        for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
            const double p = 2 * image.rgba[i], q = 2 * image.rgba[i + 1];
            if (thin && p / 2 + q / 2 > thin_depth) continue;
            const double front =
                thin ? thin_front_weight(p, q) : FrontWeightTable::get().lookup(p, q);
            const double back = opacity_from_depth(p / 2 + q / 2) - front;
            // Node coordinates near 255 are good to 3e-5 of a cell, over which the weight changes
            // by less than .01; all else is rounding.
            EXPECT_NEAR(image.rgba[i + 2], front, 2e-6) << p << " " << q;
            EXPECT_NEAR(image.rgba[i + 3], back, 2e-6) << p << " " << q;
        }
    }
}

// --- whole segments ---

struct IntervalTextures {
    int count = 0;
    gl::Texture intervals, starts;
};

IntervalTextures upload(const ShaderIntervals& from) {
    IntervalTextures textures{
        from.count,
        gl::Texture::make_2d(gl::TextureFormat::rgba32f, from.count, ShaderIntervals::rows),
        gl::Texture::make_2d(gl::TextureFormat::r32f, ShaderIntervals::start_count, 1)};
    textures.intervals.upload({0, 0, 0, from.count, ShaderIntervals::rows, 1},
                              std::span<const float>(from.texels));
    textures.starts.upload({0, 0, 0, ShaderIntervals::start_count, 1, 1},
                           std::span<const float>(from.starts));
    return textures;
}

// Returns the largest difference from integrate_segment() of any pixel and channel; infinity for a
// NaN.
double worst_analytic(const TransferFunction& transfer_function, bool colored, float length) {
    const IntervalTextures textures =
        upload(make_intervals(pieces_between(transfer_function, 0, 1, false), {0, 1}, {}, 0));
    gl::Defines defines;
    defines.set("INTERVALS", textures.count);
    if (colored) defines.set("TABLE_COLORED", "");
    gl::Program program = integrating_program("optics/analytic_segment.glsl", defines);
    textures.intervals.bind(0);
    textures.starts.bind(1);
    program.set("intervals", 0);
    program.set("interval_starts", 1);
    program.set("world_length", length);
    const glm::dvec3 single_color = transfer_function.knots().front().optics.color;
    program.set("single_color", glm::vec3(single_color));
    const Image image = run(program);
    double worst = 0;
    for (int row = 0; row < edge; ++row) {
        for (int column = 0; column < edge; ++column) {
            const auto [front, back] = scalars_of(column, row);
            const SegmentIntegral expected =
                integrate_segment(transfer_function, front, back, length);
            const float* const pixel = image.pixel(column, row);
            for (int channel = 0; channel < 4; ++channel) {
                const double value = channel < 3 ? expected.color[channel] : expected.alpha;
                const double error = std::abs(pixel[channel] - value);
                if (!(error <= worst)) {
                    worst = std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
                }
            }
        }
    }
    return worst;
}

// Returns a transfer function with points at multiples of 1/32, which float32 holds exactly: a
// ramp, a peak, a gap and a step.
TransferFunction crooked(double scale, bool colored) {
    const glm::dvec3 grey(.75, .5, .25);
    const auto color = [&](const glm::dvec3& other) { return colored ? other : grey; };
    return TransferFunction::linear(
        {knot(0, color({0, 0, 1}), 0), knot(.28125, color({0, 1, 0}), 1 * scale),
         knot(.3125, color({1, 1, 0}), 30 * scale), knot(.34375, color({1, 0, 0}), 0),
         knot(.5, color({.2, .9, .8}), 0), knot(.75, color({.2, .4, .8}), 2 * scale),
         knot(.75, color({1, .5, 0}), 6 * scale), knot(.9375, color({1, 0, 1}), 5 * scale)});
}

TEST_F(SegmentTwins, AnalyticSegmentsMatchTheIntegralInCpp) {
    for (const bool colored : {true, false}) {
        const TransferFunction transfer_function = crooked(1, colored);
        for (const float length : {1e-4f, .35f, 4.0f, 100.0f}) {
            // The bound is 3e-6 of the weights (FrontWeightsMatchPieceWeightsInCpp), as those of a
            // segment's pieces add up to less than 1, and some roundings.
            EXPECT_LE(worst_analytic(transfer_function, colored, length), 4e-6) << length;
        }
    }
}

TEST_F(SegmentTwins, AnalyticSegmentsArePreciseAtExtremes) {
    const TransferFunction one_piece = TransferFunction::linear({knot(0, {1, .5, 0}, 2)});
    EXPECT_LE(worst_analytic(one_piece, true, .7f), 4e-6);
    const TransferFunction nothing =
        TransferFunction::linear({knot(.25, {1, .5, 0}, 0), knot(.5, {1, 1, 0}, 0)});
    EXPECT_EQ(worst_analytic(nothing, true, .7f), 0);
    EXPECT_EQ(worst_analytic(crooked(1, true), true, 0), 0);
    EXPECT_LE(worst_analytic(crooked(1e20, true), true, 1), 4e-6);
    EXPECT_LE(worst_analytic(crooked(1e28, true), true, 1), 4e-6);
}

}  // namespace
}  // namespace lamina
