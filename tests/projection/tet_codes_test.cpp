// SPDX-License-Identifier: Apache-2.0
// Bounds on the lists and dispatches of meshes on codes (projection/gl_tet_codes.h). Other tests
// compare their pictures with those of the cpu engine.
#include "projection/gl_tet_codes.h"

#include "base/error.h"
#include "projection/tile_lists.h"
#include "projection_fixture.h"
#include "support/split_box.h"

namespace lamina {
namespace {

// Areas of 6, 0, 1 and 4 tiles.
const std::vector<PixelArea> some_areas{
    {7, 16, 8, 23}, {0, -1, 0, -1}, {8, 15, 0, 7}, {3, 8, 7, 8}};

TEST(TileLists, CountTheEntriesThatTheyList) {
    TileLists lists;
    lists.list(some_areas, 24, 24,
               [](std::size_t item, int, int) { return static_cast<std::uint32_t>(item); });
    EXPECT_EQ(lists.entries.size(), 6 + 0 + 1 + 4);
    EXPECT_EQ(TileLists::count(some_areas), lists.entries.size());
}

TEST(TileLists, CountBeyond32Bits) {
    // 2^20 tiles each, 2^13 times.
    const std::vector<PixelArea> areas(1 << 13, PixelArea{0, 8191, 0, 8191});
    EXPECT_EQ(TileLists::count(areas), std::size_t{1} << 33);
    EXPECT_EQ(TileLists::fitting(areas, GlTetCodes::most_entries), 16);
}

TEST(TileLists, FitIntoTheBoundButForOneItem) {
    const std::span<const PixelArea> areas(some_areas);
    EXPECT_EQ(TileLists::fitting(areas, 11), 4);
    EXPECT_EQ(TileLists::fitting(areas, 10), 3);
    EXPECT_EQ(TileLists::fitting(areas, 6), 2);
    EXPECT_EQ(TileLists::fitting(areas, 5), 1);
    EXPECT_EQ(TileLists::fitting(areas.first(0), 5), 0);
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
