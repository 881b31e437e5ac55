// SPDX-License-Identifier: Apache-2.0
// Compares the self-test's exact values and bounds with values from other sources.
#include "selftest/layered_pieces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/tracer.h"
#include "selftest/case_makers.h"
#include "selftest/picture_bounds.h"

namespace lamina::selftest {
namespace {

// The ray runs along the layers' axis; extinction goes 0 .. 2 .. 0 over a length of 3: optical
// depth 3.
TEST(LayeredPieces, HaveTheOpticalDepthOfATent) {
    LayeredBox box;
    box.samples = {0, 1, 0};
    box.edges = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 3}}};
    const TransferFunction optics = optics_of({{0, {{1, 1, 1}, 0}}, {1, {{1, 1, 1}, 2}}});
    const auto pieces = exact_pieces(box, optics, {{.5, .5, -2}, {0, 0, 1}});
    ASSERT_EQ(pieces.size(), 2u);
    const auto pixel = composite_exactly(pieces);
    EXPECT_NEAR(pixel[3], -std::expm1(-3.0), 1e-15);  // some roundings of a double
    EXPECT_TRUE(exact_pieces(box, optics, {{1.5, .5, -2}, {0, 0, 1}}).empty());
}

// Compares the exact picture of a layered box with the volume tracer, which knows nothing of
// layers.
TEST(LayeredPieces, AgreeWithTheTracer) {
    SelftestScene scene = plain_scene("", "");
    scene.box.samples = {0, 1, .25, .5};
    scene.scene.transfer_function =
        optics_of({{.125, {{.1, .3, 1}, 0}}, {.5, {{.3, 1, .3}, 4}}, {1, {{1, .5, .1}, .5}}});
    const PictureBounds bounds = layered_picture(scene, traces()[0], nullptr);
    const PreciseImage traced =
        trace_volume(scene.box.volume(), *scene.scene.transfer_function,
                     View(*scene.scene.camera, scene.scene.width, scene.scene.height), {1e-12})
            .image;
    for (std::size_t i = 0; i < bounds.exact.size(); ++i) {
        for (std::size_t c = 0; c < 4; ++c)
            // Tracer 1e-12, and rounding.
            EXPECT_NEAR(traced.rgba[4 * i + c], bounds.exact[i][c], 1e-11);
    }
}

// If only rounding is uncertain, bounds contain the exact value and are not much wider than
// rounding requires: a homogeneous box of depth D has D exp(-D) (some 2^-20), at most .4e-6.
TEST(LayeredPieces, HaveTightBounds) {
    SelftestScene scene = plain_scene("", "");
    scene.scene.transfer_function = optics_of({{0, {{1, 1, 1}, 1}}});
    scene.scene.slice.samples = 4;
    const PictureBounds bounds = layered_picture(scene, way_named("slice post float32"), nullptr);
    const std::size_t middle = 24 * 9 + 12;
    const Interval alpha = bounds.possible[middle][3];
    EXPECT_LE(alpha.lo, bounds.exact[middle][3]);
    EXPECT_GE(alpha.hi, bounds.exact[middle][3]);
    // Early termination may hide 1 / 255 / 1024 = 3.8e-6 on either side. Rounding adds about 5 *
    // 2^-20 for chord ends and lengths, and 8 * 2^-22 for blends.
    EXPECT_LE(alpha.width(), 2 * 3.83e-6 + 8e-6);
}

TEST(PixelBounds, IntervalsHoldEveryChoice) {
    const std::vector<PieceBounds> pieces{{{.5, 1.5}, {{{0, .2}, {.4, .4}, {1, 1}}}},
                                          {{.1, 3}, {{{.9, 1}, {.1, .6}, {0, 0}}}}};
    const PixelBounds pixel = composite(pieces, {});
    for (const double a : {.5, .8, 1.5})
        for (const double b : {.1, 1., 3.})
            for (const double share : {0., .3, 1.}) {
                const auto exactly = [&](const PieceBounds& piece, double depth) {
                    PieceBounds chosen{{depth, depth}, {}};
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double color = piece.color[c].lo + share * piece.color[c].width();
                        chosen.color[c] = {color, color};
                    }
                    return chosen;
                };
                const auto value =
                    composite_exactly({exactly(pieces[0], a), exactly(pieces[1], b)});
                for (std::size_t c = 0; c < 4; ++c) {
                    EXPECT_GE(value[c], pixel[c].lo - 1e-15);
                    EXPECT_LE(value[c], pixel[c].hi + 1e-15);
                }
            }
}

}  // namespace
}  // namespace lamina::selftest
