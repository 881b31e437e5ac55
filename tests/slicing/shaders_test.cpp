// SPDX-License-Identifier: Apache-2.0
// Every specialisation of the slab shader that a plan can ask for compiles, under OSMesa and by
// glslangValidator.
#include <cstdlib>
#include <set>

#include "slicing_fixture.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

std::vector<SlicePlan> every_plan() {
    std::vector<SlicePlan> plans;
    for (const VolumeSampling sampling : {VolumeSampling::none, VolumeSampling::fetch,
                                          VolumeSampling::filtered, VolumeSampling::hardware}) {
        for (int bits = 0; bits < 128; ++bits) {
            SlicePlan plan;
            plan.sampling = sampling;
            plan.orthographic = (bits & 1) != 0;
            plan.single_color = (bits & 2) != 0;
            plan.nan_transparent = (bits & 4) != 0;
            plan.classification =
                (bits & 8) != 0 ? Classification::preintegrated : Classification::post;
            plan.table_filtered = (bits & 16) != 0;
            plan.table.colored = !plan.single_color;
            plan.table.length_layers = (bits & 32) != 0 ? 5 : 1;
            plan.precise_rays = (bits & 64) != 0;
            plans.push_back(plan);
        }
    }
    return plans;
}

// Different plans may ask for the same defines: each specialisation once, by its text.
std::set<std::string> every_source() {
    std::set<std::string> sources;
    for (const SlicePlan& plan : every_plan()) {
        for (const int intervals : {1, 6}) {
            sources.insert(
                gl::compose_shader("slicing/slab.frag", slab_defines(plan, intervals, 256)).text);
        }
    }
    return sources;
}

TEST_F(SlicingTest, EverySpecialisationCompiles) {
    std::set<std::string> seen;
    for (const SlicePlan& plan : every_plan()) {
        for (const int intervals : {1, 6}) {
            const gl::Defines defines = slab_defines(plan, intervals, 256);
            if (!seen.insert(gl::compose_shader("slicing/slab.frag", defines).text).second)
                continue;
            EXPECT_NO_THROW(gl::Program("slicing/slab.vert", "slicing/slab.frag", defines));
        }
    }
    EXPECT_GE(seen.size(), 50u);
}

TEST(SlicingShaders, EverySpecialisationPassesGlslang) {
    if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "no glslangValidator";
    TemporaryFolder folder;
    std::string files;
    int number = 0;
    for (const std::string& source : every_source()) {
        const auto file = folder / ("slab" + std::to_string(number++) + ".frag");
        write_bytes_to(file, source);
        files += " '" + file.string() + "'";
    }
    EXPECT_EQ(std::system(
                  ("glslangValidator" + files + " > '" + (folder / "log").string() + "'").c_str()),
              0)
        << read_bytes_of(folder / "log");
}

}  // namespace
}  // namespace lamina
