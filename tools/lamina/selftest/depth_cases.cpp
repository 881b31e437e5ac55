// SPDX-License-Identifier: Apache-2.0
// Scenes of many slabs, whose sums must not drift.
#include <fmt/format.h>

#include <algorithm>

#include "selftest/case_makers.h"

namespace lamina::selftest {
namespace {

constexpr const char* depth_group = "depth";

SelftestScene slabs_scene(const std::string& name, int slabs, double extinction) {
    SelftestScene scene = plain_scene(
        fmt::format("{}_{}", name, slabs),
        fmt::format("{} slabs of a ramp of extinction up to {:g}, in colour", slabs, extinction));
    scene.scene.slice.samples = slabs;
    scene.scene.max_error = std::min(1.0, extinction);  // faint pictures allow only small omissions
    scene.scene.transfer_function =
        optics_of({{0, {{.1, .3, 1}, 0}}, {1, {{1, .5, .1}, extinction}}});
    scene.scene.width = 12;
    scene.scene.height = 9;
    scene.mesh = nullptr;
    return scene;
}

}  // namespace

std::vector<SelftestCase> depth_cases() {
    std::vector<SelftestCase> cases;
    const auto add = [&](const SelftestScene& scene, const std::vector<DrawingWay>& ways) {
        for (SelftestCase& each : cases_of(depth_group, scene, ways)) cases.push_back(each);
    };
    for (const int slabs : {1, 2, 3, 17, 255, 4096, 65536}) {
        add(slabs_scene("medium", slabs, 2), float_ways());
        add(slabs_scene("dense", slabs, 200), float_ways());
    }
    for (const int slabs : {4096, 65536}) add(slabs_scene("faint", slabs, 1e-6), float_ways());
    const std::vector<int> twos(16, 2);
    for (const double extinction : {2., 200.}) {
        add(slabs_scene(fmt::format("tree_{:g}", extinction), 65536, extinction),
            {tree_way("2^16", twos, Target::float32),
             tree_way("256x256", {256, 256}, Target::fixed16)});
    }
    add(slabs_scene("tree", 3, 2), {tree_way("2^16", twos, Target::float32)});
    return cases;
}

}  // namespace lamina::selftest
