// SPDX-License-Identifier: Apache-2.0
#include "preintegration/preintegration_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "base/error.h"
#include "optics/opacity.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;
using test::smooth;

// Returns a function whose knots are nodes of a table of 33 nodes over [0, 1]; one is a step.
TransferFunction stepped() {
    return TransferFunction::linear({knot(0, {1, 0, 0}, 0), knot(.25, {1, .5, 0}, 2),
                                     knot(.5, {1, .5, 0}, 1), knot(.5, {0, 0, 1}, 5),
                                     knot(1, {0, 1, 0}, 8)});
}

TransferFunction grey_ramp() {
    return TransferFunction::linear({knot(0, {.5, .25, 1}, 0), knot(1, {.5, .25, 1}, 3)});
}

double worst_difference(const SegmentIntegral& a, const SegmentIntegral& b) {
    double worst = std::abs(a.alpha - b.alpha);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a.color[c] - b.color[c]));
    return worst;
}

TableRequest request_of(int nodes, int layers) {
    TableRequest request;
    request.kind = TableKind::uniform;
    request.max_length = 3;
    request.scalar_nodes = nodes;
    request.length_layers = layers;
    request.format = TableFormat::float32;
    return request;
}

constexpr LengthMapping mappings[] = {LengthMapping::octave, LengthMapping::log2,
                                      LengthMapping::linear};
constexpr TableStore stores[] = {TableStore::mean_extinction, TableStore::opacity};

TEST(UniformTable, IsExactAtItsNodesAndLengths) {
    for (const auto& f : {smooth(), stepped()}) {
        for (const LengthMapping mapping : mappings) {
            for (const TableStore store : stores) {
                TableRequest request = request_of(33, 5);
                request.mapping = mapping;
                request.store = store;
                const UniformTable table(f, request);
                for (int i = 0; i < 33 * 33 * 5; ++i) {
                    const double front = (i % 33) / 32.0, back = (i / 33 % 33) / 32.0;
                    const double length = table.length_of(i / (33 * 33));
                    // Rounding: three floats of 6e-8 each and a few roundings.
                    EXPECT_LE(worst_difference(table.lookup(front, back, length),
                                               integrate_segment(f, front, back, length)),
                              4e-7)
                        << front << " " << back << " " << length;
                }
            }
        }
    }
}

TEST(UniformTable, LengthsAndLayersAreEachOthersInverse) {
    TableRequest request = request_of(2, 8);
    request.max_length = 5;
    for (const LengthMapping mapping : mappings) {
        request.mapping = mapping;
        const UniformTable table(smooth(), request);
        EXPECT_EQ(table.length_of(0), 0);
        EXPECT_DOUBLE_EQ(table.length_of(7), 5);
        for (int layer = 0; layer < 8; ++layer) {
            EXPECT_NEAR(table.layer_of(table.length_of(layer)), layer, 1e-12);
        }
        EXPECT_EQ(table.layer_of(6), 7);
        const double middle = (table.length_of(4) + table.length_of(5)) / 2;
        // Equation 1 of Kraus puts the length 1.5 dl at log2(1.5) of its octave, which is .085 too
        // far.
        const double expected = mapping == LengthMapping::log2 ? 4 + std::log2(1.5) : 4.5;
        EXPECT_NEAR(table.layer_of(middle), expected, 1e-12);
        EXPECT_NEAR(table.layer_of(table.length_of(1) / 4), .25, 1e-12);
    }
}

TEST(UniformTable, MeanExtinctionMakesOpacityExactAtEveryLength) {
    const UniformTable table(smooth(), request_of(33, 4));
    for (const double length : {1e-9, 1e-3, .37, 2.9, 50.0}) {
        const SegmentIntegral expected = integrate_segment(smooth(), 0.25, 0.75, length);
        EXPECT_NEAR(table.lookup(.25, .75, length).alpha, expected.alpha, 1e-7 * expected.alpha);
    }
}

TEST(UniformTable, OneColorTakesOneChannel) {
    TableRequest request = request_of(16, 6);
    request.colored = false;
    const UniformTable table(grey_ramp(), request);
    EXPECT_EQ(table.layers, 1);
    EXPECT_EQ(table.byte_count(), 16 * 16 * 4);
    const SegmentIntegral expected = integrate_segment(grey_ramp(), .15, .8, 1.7);
    // The mean extinction of a single linear piece is bilinear in the scalars.
    EXPECT_LE(worst_difference(table.lookup(.15, .8, 1.7), expected), 3e-7);

    request.store = TableStore::opacity;
    EXPECT_EQ(UniformTable(grey_ramp(), request).layers, 6);
    request.length_layers = 1;
    const UniformTable longest(grey_ramp(), request);
    EXPECT_NEAR(longest.lookup(1, 1, .1).alpha, opacity_from_depth(3 * 3), 1e-7);
}

// Returns the largest error of colour of a table, in 1/255, over rays of 10 to 10000 equal segments
// that together cover all scalars.
double worst_color(const TransferFunction& f, const UniformTable& table) {
    double worst = 0;
    for (const int count : {10, 100, 1000, 10000}) {
        // Lengths from the table's largest one down to 1e-4 of it, for meshes with edge ratios up
        // to 1e4.
        for (const double share : {1e-4, .0021, .034, .3, .73, 1.0}) {
            const double length = table.request.max_length * share;
            if (length * count > 30 || length * count < .1) continue;
            glm::dvec3 color(0);
            double transmittance = 1;
            for (int i = 0; i < count; ++i) {
                const SegmentIntegral part =
                    table.lookup(double(i) / count, double(i + 1) / count, length);
                color += transmittance * part.color;
                transmittance *= 1 - part.alpha;
            }
            const SegmentIntegral whole = integrate_segment(f, 0, 1, length * count);
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, 255 * std::abs(color[c] - whole.color[c]));
            }
        }
    }
    return worst;
}

TEST(UniformTable, VariantsRankAsStatedInNumerics) {
    const auto worst = [](TableStore store, LengthMapping mapping, TableFormat format) {
        TableRequest request = request_of(65, 16);
        request.max_length = 10;
        request.store = store;
        request.mapping = mapping;
        request.format = format;
        return worst_color(smooth(), UniformTable(smooth(), request));
    };
    constexpr auto opacity = TableStore::opacity, mean = TableStore::mean_extinction;
    constexpr auto octave = LengthMapping::octave, log2 = LengthMapping::log2;
    constexpr auto linear = LengthMapping::linear;
    constexpr auto fixed16 = TableFormat::fixed16, fixed8 = TableFormat::fixed8;
    // Opacities in 8 bits lose thin segments. With equally spaced lengths, thin segments lie only
    // in the first step between lengths, in which opacity bends. Equation 1 of Kraus makes thin
    // segments up to 6.1 % too dense (docs/numerics.md, section 5), which moves colours by some
    // units of 1/255; octaves do not.
    EXPECT_GT(worst(opacity, octave, fixed8), 100);
    const double of_linear = worst(opacity, linear, fixed16);
    const double of_log2 = worst(opacity, log2, fixed16);
    const double of_octave = worst(opacity, octave, fixed16);
    EXPECT_GT(of_linear, 20);
    EXPECT_GT(of_log2, 1.5);
    EXPECT_LT(of_log2, 6);
    EXPECT_LT(of_octave, .6 * of_log2);
    // Opacity is exact. The remaining error is half a code of 16 bits, and the bend of emission
    // between nodes.
    const double of_mean = worst(mean, octave, fixed16);
    EXPECT_LT(of_mean, .1);
    EXPECT_LT(of_mean, .25 * of_octave);
}

TEST(UniformTable, LogarithmicLengthsOverestimateByUpToSixPercent) {
    // At so small a depth alpha is linear in length. Expected (docs/numerics.md, section 5): (1 +
    // log2(u)) / u - 1 at u times the start of an octave, at most .0615 (at u = 1.36).
    const auto f = TransferFunction::linear({knot(0, {1, 1, 1}, 1e-6)});
    TableRequest request = request_of(2, 8);
    request.store = TableStore::opacity;
    double worst_log2 = 0, worst_octave = 0;
    for (const LengthMapping mapping : {LengthMapping::log2, LengthMapping::octave}) {
        request.mapping = mapping;
        const UniformTable table(f, request);
        double& worst = mapping == LengthMapping::log2 ? worst_log2 : worst_octave;
        for (int i = 0; i <= 1000; ++i) {
            const double length = .75 + .75 * i / 1000;
            worst = std::max(worst, table.lookup(0, 0, length).alpha / (1e-6 * length) - 1);
        }
    }
    EXPECT_NEAR(worst_log2, .0615, .0005);
    EXPECT_LT(worst_octave, 1e-6);
}

// Returns the largest difference of texels, times their scales, divided by the largest texel.
double texel_difference(const UniformTable& a, const UniformTable& b) {
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const double x = double{a.texels[i]} * a.scale, y = double{b.texels[i]} * b.scale;
        worst = std::max(worst, std::abs(x - y));
        largest = std::max(largest, x);
    }
    return worst / largest;
}

TEST(UniformTable, IncrementalTablesConvergeToExactOnes) {
    for (const TableStore store : stores) {
        for (const LengthMapping mapping : mappings) {
            std::array<double, 2> differences{};
            for (const int refined : {0, 1}) {
                TableRequest request = request_of(refined ? 129 : 33, 7);
                request.store = store;
                request.mapping = mapping;
                const UniformTable exact(smooth(), request);
                request.construction = TableConstruction::incremental;
                differences[refined] = texel_difference(exact, UniformTable(smooth(), request));
            }
            // Bilinear interpolation of a function with kinks has errors of at least first order in
            // the distance of the nodes, of which the second table has a quarter.
            EXPECT_LT(differences[0], .02);
            EXPECT_LT(differences[1], differences[0] / 3);
            EXPECT_GT(differences[0], 0);
        }
    }
}

TEST(UniformTable, IncrementalIsExactForOneExtinctionAndColor) {
    const auto f = TransferFunction::linear({knot(0, {1, .5, .25}, 2)});
    for (const TableStore store : stores) {
        for (const LengthMapping mapping : mappings) {
            TableRequest request = request_of(5, 9);
            request.store = store;
            request.mapping = mapping;
            const UniformTable exact(f, request);
            request.construction = TableConstruction::incremental;
            // Rounding: one float for each layer.
            EXPECT_LE(texel_difference(exact, UniformTable(f, request)), 9 * 6e-8);
        }
    }
}

TEST(UniformTable, FormatsRoundToNearest) {
    const TableRequest request = request_of(20, 4);
    const UniformTable exact(stepped(), request);
    for (const TableFormat format :
         {TableFormat::fixed16, TableFormat::fixed8, TableFormat::float16}) {
        TableRequest rounded_request = request;
        rounded_request.format = format;
        const UniformTable rounded(stepped(), rounded_request);
        const bool half = format == TableFormat::float16;
        const double codes = format == TableFormat::fixed8 ? 255 : 65535;
        for (std::size_t i = 0; i < exact.texels.size(); ++i) {
            const double value = exact.texels[i], found = double{rounded.texels[i]};
            // The bound is half of the last place, a code or 11 bits of the number itself. The
            // float that holds the code is off by another 2e-5 of that.
            const double bound = half ? std::max(value * 0x1p-11, 0x1p-25 * rounded.scale)
                                      : .5 / codes * rounded.scale;
            EXPECT_NEAR(found * rounded.scale, value, bound * (1 + 1e-4) + 1e-7 * value);
            if (!half) {
                EXPECT_NEAR(found * codes, std::round(found * codes), 1e-2);
            }
        }
        const float largest = *std::ranges::max_element(rounded.texels);
        if (half) {
            EXPECT_LT(largest, 65504);
        } else {
            EXPECT_EQ(largest, 1);
        }
    }
    EXPECT_EQ(exact.byte_count(), 20 * 20 * 4 * 16);
}

// Looks up every variant of a table at and beyond the ends of its scalars and lengths.
void expect_finite(const TransferFunction& f, TableRequest request) {
    for (const TableStore store : stores) {
        for (const LengthMapping mapping : mappings) {
            for (const TableFormat format :
                 {TableFormat::fixed16, TableFormat::float16, TableFormat::float32}) {
                for (const auto construction :
                     {TableConstruction::exact, TableConstruction::incremental}) {
                    request.store = store;
                    request.mapping = mapping;
                    request.format = format;
                    request.construction = construction;
                    const UniformTable table(f, request);
                    for (const float texel : table.texels) {
                        ASSERT_TRUE(texel >= 0 && texel <= std::numeric_limits<float>::max());
                    }
                    for (const double front : {request.lo, request.lo - 1, request.hi}) {
                        for (const double length : {0.0, 1e-30, .5, 1e3}) {
                            const auto found = table.lookup(front, request.hi, length);
                            ASSERT_TRUE(found.alpha >= 0 && found.alpha <= 1);
                            for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(found.color[c]));
                        }
                    }
                }
            }
        }
    }
}

TEST(UniformTable, IsFiniteForExtremeFunctionsAndLengths) {
    TableRequest request = request_of(8, 5);
    expect_finite(TransferFunction::linear({knot(0, {1, 0, 1}, 0)}), request);
    expect_finite(TransferFunction::linear({knot(0, {1, 0, 1}, 1e300), knot(1, {0, 1, 9}, 0)}),
                  request);
    expect_finite(
        TransferFunction::linear({knot(0, {1, 0, 1}, 1e-300), knot(1, {0, 1, 9}, 1e-310)}),
        request);
    expect_finite(stepped(), request);
    request.max_length = 0;
    expect_finite(stepped(), request);
    request.length_layers = 1;
    expect_finite(stepped(), request);
    request.max_length = 1e-300;
    request.length_layers = 64;
    expect_finite(stepped(), request);
    request.max_length = 1e200;
    expect_finite(stepped(), request);
    request = request_of(8, 3);
    request.lo = request.hi = .5;
    expect_finite(stepped(), request);
    // Exactly at a step the later knot counts.
    const UniformTable point(stepped(), request);
    EXPECT_NEAR(point.lookup(.5, .5, .2).alpha, opacity_from_depth(5 * .2), 1e-7);
}

TEST(UniformTable, OpaqueStaysOpaque) {
    const auto f = TransferFunction::linear({knot(0, {1, .5, 0}, 1e30), knot(1, {1, .5, 0}, 1e30)});
    for (const TableFormat format :
         {TableFormat::fixed16, TableFormat::float16, TableFormat::float32}) {
        TableRequest request = request_of(4, 4);
        request.format = format;
        const auto found = UniformTable(f, request).lookup(.1, .9, .01);
        EXPECT_EQ(found.alpha, 1);
        EXPECT_NEAR(found.color.g, .5, 1e-3);  // a half float's
    }
}

TEST(UniformTable, RefusesWhatIsTooLarge) {
    EXPECT_THROW(UniformTable(smooth(), request_of(4096, 5)), Error);
}

}  // namespace
}  // namespace lamina
