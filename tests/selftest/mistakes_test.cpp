// SPDX-License-Identifier: Apache-2.0
// Tests the self-test: renderers with one mistake each must fail in the cases that show this
// mistake, and in no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "selftest/mistaken_maker.h"
#include "selftest/selftest.h"
#include "tiles/cpu_capabilities.h"

namespace lamina::selftest {
namespace {

std::vector<SelftestResult> run_with(Mistake mistake) {
    static const Capabilities capabilities = cpu_capabilities();
    std::vector<SelftestCase> cases =
        selftest_cases({"optics", "meshes", "views", "clips", "light", "metamorphic"});
    std::erase_if(cases, [](const SelftestCase& each) { return each.scene == "hub_1e6"; });
    return run_selftest(cases, MistakenMaker(capabilities, mistake));
}

bool failed(const std::vector<SelftestResult>& results, const std::string& scene,
            const std::string& way) {
    const auto found = std::ranges::find_if(results, [&](const SelftestResult& result) {
        return result.scene == scene && result.way == way;
    });
    EXPECT_NE(found, results.end()) << scene << ", " << way;
    return found != results.end() && found->outcome.verdict == Verdict::failed;
}

bool starts_with(const std::string& text, const std::string& beginning) {
    return text.rfind(beginning, 0) == 0;
}

TEST(Mistakes, ExtinctionOffByOnePercentShowsWhereverLightIsLeft) {
    const auto results = run_with(Mistake::extinction);
    for (const char* way :
         {"trace volume", "trace mesh", "slice post float32", "slice preintegrated float32",
          "project float32", "project analytic float32"}) {
        for (const char* scene : {"homogeneous_1e-08", "homogeneous_1", "ramp_1e-06", "steps"})
            EXPECT_TRUE(failed(results, scene, way)) << scene << ", " << way;
    }
}

TEST(Mistakes, RaysOffByAThousandthShow) {
    const auto results = run_with(Mistake::position);
    for (const char* way : {"trace volume", "slice post float32", "project float32"}) {
        for (const char* scene : {"jump_1e8", "fov_10", "eye_inside", "eye_on_corner"})
            EXPECT_TRUE(failed(results, scene, way)) << scene << ", " << way;
    }
}

TEST(Mistakes, OneSlabTooFewShowsInSlicingAlone) {
    const auto results = run_with(Mistake::slabs);
    EXPECT_TRUE(failed(results, "jump_1e8", "slice post float32"));
    EXPECT_TRUE(failed(results, "steps", "slice post float32"));
    for (const SelftestResult& result : results) {
        if (starts_with(result.way, "slice")) continue;
        EXPECT_EQ(result.outcome.verdict, Verdict::passed) << result.scene << ", " << result.way;
    }
}

TEST(Mistakes, ThicknessAlongDepthShowsInPerspectiveProjectionAlone) {
    const auto results = run_with(Mistake::thickness);
    EXPECT_TRUE(failed(results, "fov_90", "project float32"));
    EXPECT_TRUE(failed(results, "fov_170", "project float32"));
    for (const SelftestResult& result : results) {
        if (starts_with(result.way, "project") && !starts_with(result.scene, "orthographic"))
            continue;
        EXPECT_EQ(result.outcome.verdict, Verdict::passed) << result.scene << ", " << result.way;
    }
}

TEST(Mistakes, NoVisibilityOrderShowsInColoredMeshesAlone) {
    const auto results = run_with(Mistake::order);
    EXPECT_TRUE(failed(results, "kuhn_8", "project float32"));
    EXPECT_TRUE(failed(results, "irregular", "project analytic float32"));
    EXPECT_TRUE(failed(results, "reorder_tets", "project float32"));
    EXPECT_FALSE(failed(results, "edge_fan", "project float32"));
    EXPECT_FALSE(failed(results, "homogeneous_1", "project float32"));
}

TEST(Mistakes, PlanesOffByAThousandthShowInCutPicturesAlone) {
    const auto results = run_with(Mistake::clip);
    for (const char* way : {"trace volume", "trace mesh", "slice post float32",
                            "slice exact float32", "project float32", "project analytic float32"}) {
        for (const char* scene : {"oblique", "wedge", "eye_in_cut"})
            EXPECT_TRUE(failed(results, scene, way)) << scene << ", " << way;
    }
    for (const SelftestResult& result : results) {
        if (result.group == "clips") continue;
        EXPECT_EQ(result.outcome.verdict, Verdict::passed) << result.scene << ", " << result.way;
    }
}

TEST(Mistakes, AHundredthOfAmbientLightShowsInLitPicturesAlone) {
    const auto results = run_with(Mistake::light);
    for (const char* way : {"trace volume", "trace mesh", "slice exact float32"}) {
        for (const char* scene : {"directional", "headlight", "steep", "ambient"})
            EXPECT_TRUE(failed(results, scene, way)) << scene << ", " << way;
        EXPECT_FALSE(failed(results, "flat", way)) << way;
    }
    for (const SelftestResult& result : results) {
        if (result.group == "light") continue;
        EXPECT_EQ(result.outcome.verdict, Verdict::passed) << result.scene << ", " << result.way;
    }
}

TEST(Mistakes, TwoBitsTooFewShowsInEmulatedTargetsAlone) {
    const auto results = run_with(Mistake::bits);
    std::size_t failures = 0;
    for (const SelftestResult& result : results) {
        if (result.outcome.verdict == Verdict::passed) continue;
        ++failures;
        EXPECT_NE(result.way.find("emulated"), std::string::npos) << result.scene;
    }
    EXPECT_GE(failures, 1u);
}

}  // namespace
}  // namespace lamina::selftest
