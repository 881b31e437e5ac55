// SPDX-License-Identifier: Apache-2.0
// Bounds on the lists and dispatches of meshes on codes (projection/gl_tet_codes.h). Other tests
// compare their pictures with those of the cpu engine.
#include "projection/gl_tet_codes.h"

#include <cmath>
#include <random>
#include <tuple>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include "base/error.h"
#include "projection/tile_lists.h"
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

using Lists = TileLists<std::uint32_t>;

// Areas of 6, 0, 1 and 4 tiles.
const std::vector<PixelArea> some_areas{
    {7, 16, 8, 23}, {0, -1, 0, -1}, {8, 15, 0, 7}, {3, 8, 7, 8}};

std::size_t list(Lists& lists, std::span<const PixelArea> areas, int width, int height,
                 std::uint32_t most) {
    return lists.list(areas, width, height, most,
                      [](std::size_t item, int, int) { return static_cast<std::uint32_t>(item); });
}

TEST(TileLists, ListNoMoreThanTheirBound) {
    Lists lists;
    EXPECT_EQ(list(lists, some_areas, 24, 24, 11), 11);
    EXPECT_EQ(lists.entries.size(), 6 + 0 + 1 + 4);
    EXPECT_EQ(list(lists, some_areas, 24, 24, 10), 11);
    EXPECT_TRUE(lists.tiles.empty());
}

// Parts of the items are listed side by side, on as many cores as there are.
TEST(TileLists, AreTheSameOnAnyNumberOfCores) {
    constexpr int width = 203, height = 157;
    std::mt19937 random(1);
    const auto ends = [&](int pixels) {
        const auto a = static_cast<int>(random() % static_cast<unsigned>(pixels));
        return std::pair(a, std::min(a + static_cast<int>(random() % 20), pixels) - 1);
    };
    std::vector<PixelArea> areas(70000);
    for (PixelArea& area : areas) {
        std::tie(area.first_column, area.last_column) = ends(width);
        std::tie(area.first_row, area.last_row) = ends(height);
    }
    std::vector<std::uint32_t> expected;
    for (int row = 0; row < height; row += Lists::size) {
        for (int column = 0; column < width; column += Lists::size) {
            const PixelArea tile{column, column + Lists::size - 1, row, row + Lists::size - 1};
            for (std::uint32_t item = 0; item < areas.size(); ++item) {
                if (!areas[item].empty() && !common_pixels(areas[item], tile).empty())
                    expected.push_back(item);
            }
        }
    }
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 16);
    for (const int cores : {1, 3, 16}) {
        Lists lists;
        tbb::task_arena(cores).execute([&] { list(lists, areas, width, height, 1 << 30); });
        EXPECT_EQ(lists.entries, expected) << cores;
    }
}

TEST(TileLists, CountBeyond32Bits) {
    // 2^20 tiles each, 2^13 times.
    const std::vector<PixelArea> areas(1 << 13, PixelArea{0, 8191, 0, 8191});
    EXPECT_EQ(Lists::fitting(areas, GlTetCodes::most_entries), 4);
}

TEST(TileLists, FitIntoTheBoundButForOneItem) {
    const std::span<const PixelArea> areas(some_areas);
    EXPECT_EQ(Lists::fitting(areas, 11), 4);
    EXPECT_EQ(Lists::fitting(areas, 10), 3);
    EXPECT_EQ(Lists::fitting(areas, 6), 2);
    EXPECT_EQ(Lists::fitting(areas, 5), 1);
    EXPECT_EQ(Lists::fitting(areas.first(0), 5), 0);
}

// Tells whether a pixel's ray meets a tet, as shaders/projection/silhouette.glsl finds it.
bool meets(const SilhouetteRecord& record, double column, double row_from_bottom) {
    const SeenTet& seen = record.seen();
    const double x = column - seen.center[0], y = row_from_bottom - seen.center[1];
    double enter = -INFINITY, leave = INFINITY;
    for (std::size_t face = 0; face < 4; ++face) {
        const auto number = [&](const SeenTet::Pairs& pairs) {
            return double{pairs.high[face]} + double{pairs.low[face]};
        };
        const double depth =
            number(seen.depth) + x * number(seen.depth_per_column) + y * number(seen.depth_per_row);
        if (face < record.front_faces())
            enter = std::max(enter, depth);
        else
            leave = std::min(leave, depth);
    }
    return leave > enter;
}

TEST(TilePixels, AreTheOnesWhoseRaysMeetTheTet) {
    constexpr int width = 61, height = 45, size = Lists::size;
    const SceneMesh mesh = scene_mesh(test::kuhn_box({3, 3, 3}, ripples));
    const TetPieces pieces(
        TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(1, {0, 0, 1}, 1)}), {0, 1});
    Camera camera;
    camera.eye = {6, -3, 7};
    camera.center = {1.5, 1.5, 1.5};
    camera.fov_y = 30;
    constexpr double margin = 1e-3;
    const TetProjector projector({mesh.mesh,
                                  mesh.scalar.values,
                                  {0, 1},
                                  pieces,
                                  WindowView(View(camera, width, height)),
                                  1e-3,
                                  margin,
                                  {}});
    int met = 0, listed = 0;
    for (std::int32_t tet = 0; tet < std::ssize(mesh.mesh.tets()); ++tet) {
        SilhouetteRecord record;
        ScreenOutline outline;
        const auto kind = projector.project({tet}, record, outline, nullptr);
        if (!kind || *kind == FragmentKind::careful) continue;
        const PixelBounds bounds = pixel_bounds(outline.points(), margin, width, height);
        const PixelArea area{bounds.first_column, bounds.last_column, height - 1 - bounds.last_row,
                             height - 1 - bounds.first_row};
        const TetOutline lines = outline_of(record, area, height, 1);
        for (int row = 0; row < height; ++row) {
            for (int column = 0; column < width; ++column) {
                const TilePixelBits pixels =
                    pixels_in_tile(area, lines, column / size * size, row / size * size);
                const bool is_listed = (pixels >> (size * (row % size) + column % size) & 1) != 0;
                const bool is_met = meets(record, column + .5, height - row - .5);
                EXPECT_TRUE(is_listed || !is_met) << tet << ": " << column << ", " << row;
                met += is_met ? 1 : 0;
                listed += is_listed ? 1 : 0;
            }
        }
    }
    // Outlines are enlarged by about 1e-3 pixel, so that few more are listed.
    EXPECT_GT(met, 5000);
    EXPECT_LT(listed, 1.01 * met);
}

TEST(TilePixels, AreThoseOfTheAreaWithoutOutline) {
    const PixelArea area{3, 12, 9, 9};
    EXPECT_EQ(pixels_in_tile(area, {}, 0, 8), TilePixelBits{0b11111000} << 8);
    EXPECT_EQ(pixels_in_tile(area, {}, 8, 8), TilePixelBits{0b00011111} << 8);
}

TEST(TetCodesDispatch, KeepsTheRoundsOfSoftware) {
    Capabilities capabilities;
    ProjectPlan plan;
    for (const bool windowed : {false, true}) {
        plan.windowed = windowed;
        for (const int intervals : {0, 10, 1000, 1400, 5000, 10000}) {
            const int entries = most_in_dispatch(plan, intervals, capabilities);
            EXPECT_GE(entries, 1);
            // Up to 16 pixels at once, which meet the same fragment if there is just one.
            const int rounds = (windowed ? 3 : 1) * 2 * intervals * entries;
            EXPECT_LT(entries > 1 ? 16 * rounds : rounds, 65535) << intervals;
        }
    }
}

TEST(TetCodesDispatch, RefusesFragmentsThatAreTooLongAlone) {
    Capabilities capabilities;
    ProjectPlan plan;
    plan.windowed = true;
    EXPECT_THROW(most_in_dispatch(plan, 11000, capabilities), Error);
    capabilities.software = false;
    EXPECT_NO_THROW(most_in_dispatch(plan, 11000, capabilities));
}

class TetCodes : public gl::EveryContextTest {
  protected:
    void SetUp() override {
        gl::EveryContextTest::SetUp();
        if (IsSkipped()) return;
        scene_.target = Target::emulated;
        scene_.emulate = {8, AlphaRounding::nearest, OverRounding::fused, 1};
        scene_.camera->eye = {6, -3, 7};
        scene_.camera->center = {2, 2, 2};
        scene_.camera->fov_y = 60;
        plan_ = plan_of(mesh_, scene_, capabilities()).project;
    }
    std::unique_ptr<GlTetCodes> renderer(std::size_t entries) const {
        return std::make_unique<GlTetCodes>(mesh_, *scene_.transfer_function, plan_, scene_.width,
                                            scene_.height, nullptr, entries);
    }

    SceneMesh mesh_ = scene_mesh(test::kuhn_box({4, 4, 4}, ripples));
    Scene scene_ = projection_scene(
        TransferFunction::linear({knot(0, {1, 0, 0}, .1), knot(1, {0, 0, 1}, 1)}), 32, 32);
    ProjectPlan plan_;
};

TEST_P(TetCodes, ShowWithShortListsWhatTheyShowWithLongOnes) {
    ASSERT_EQ(plan_.blending, Blending::registers);
    constexpr std::size_t tiles = 4 * 4;
    std::vector<Image> images;
    for (const std::size_t entries : {GlTetCodes::most_entries, tiles}) {
        const auto codes = renderer(entries);
        codes->draw(View(*scene_.camera, scene_.width, scene_.height));
        EXPECT_GT(codes->tets_drawn(), 16);  // so that lists of 16 entries are several
        images.push_back(codes->read());
    }
    EXPECT_EQ(images[0].rgba, images[1].rgba);
}

TEST_P(TetCodes, RefuseListsThatHoldNoFragmentOfTheWholePicture) {
    EXPECT_THROW(renderer(15), Error);
}

INSTANTIATE_TEST_SUITE_P(, TetCodes, gl::both_contexts, gl::context_name);

}  // namespace
}  // namespace lamina
