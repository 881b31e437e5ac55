// SPDX-License-Identifier: Apache-2.0
// Changes of a scene that must not change its picture.
#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "selftest/case_makers.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {
namespace {

constexpr const char* metamorphic_group = "metamorphic";

SelftestScene base_scene(const std::string& about = "") {
    SelftestScene scene = plain_scene("base", about);
    scene.box.edges = {{{1, 0, 0}, {0, .75, 0}, {0, 0, 1.25}}};
    scene.scene.transfer_function =
        optics_of({{.25, {{.2, .4, 1}, .25}}, {.5, {{.4, 1, .2}, 4}}, {.75, {{1, .3, .1}, .5}}});
    scene.scene.camera = camera_at(scene.box, 1.5, 40);
    scene.mesh = [](const LayeredBox& box) { return kuhn_tets(box, 2); };
    return scene;
}

template <typename Point, typename Direction>
void move_world(SelftestScene& scene, const Point& point, const Direction& direction) {
    scene.box.corner = point(scene.box.corner);
    for (glm::dvec3& edge : scene.box.edges) edge = direction(edge);
    Camera& camera = *scene.scene.camera;
    camera.eye = point(camera.eye);
    camera.center = point(camera.center);
    camera.up = direction(camera.up);
}

SelftestScene translated() {
    SelftestScene scene = base_scene("The world moved by (384, -96, 48)");
    move_world(
        scene, [](const glm::dvec3& p) { return p + glm::dvec3(384, -96, 48); },
        [](const glm::dvec3& d) { return d; });
    return scene;
}

SelftestScene rotated() {
    SelftestScene scene = base_scene("The world turned about an oblique axis");
    // The columns are those of a rotation matrix, times 7.
    const auto turn = [](const glm::dvec3& d) {
        return (d.x * glm::dvec3(2, 6, -3) + d.y * glm::dvec3(3, 2, 6) +
                d.z * glm::dvec3(6, -3, -2)) /
               7.0;
    };
    move_world(scene, turn, turn);
    return scene;
}

SelftestScene scaled(double factor, const std::string& about) {
    SelftestScene scene = base_scene(about);
    const auto scale = [factor](const glm::dvec3& d) { return factor * d; };
    move_world(scene, scale, scale);
    const auto knots = scene.scene.transfer_function->knots();
    std::vector<TransferKnot> thinner(knots.begin(), knots.end());
    for (TransferKnot& knot : thinner) knot.optics.extinction /= factor;
    scene.scene.transfer_function = optics_of(thinner);
    return scene;
}

SelftestScene stored_backwards() {
    SelftestScene scene = base_scene("All three axes of the volume stored the other way round");
    scene.box.corner = scene.box.world({1, 1, 1});
    for (glm::dvec3& edge : scene.box.edges) edge = -edge;
    std::ranges::reverse(scene.box.samples);
    return scene;
}

SelftestScene axes_exchanged() {
    SelftestScene scene = base_scene("Two axes of the volume exchanged: left-handed");
    std::swap(scene.box.edges[0], scene.box.edges[1]);
    return scene;
}

SelftestScene split_pieces() {
    SelftestScene scene = base_scene("The transfer function's pieces split in the middle");
    const auto knots = scene.scene.transfer_function->knots();
    std::vector<TransferKnot> finer;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        if (i > 0) {
            const double middle = .5 * (knots[i - 1].value + knots[i].value);
            finer.push_back({middle, scene.scene.transfer_function->at(middle)});
        }
        finer.push_back(knots[i]);
    }
    scene.scene.transfer_function = optics_of(finer);
    return scene;
}

SelftestScene more_samples() {
    SelftestScene scene = base_scene("The same ramp in 16 layers of 5 x 7 samples");
    scene.box.samples.clear();
    for (int k = 0; k <= 16; ++k) scene.box.samples.push_back(k / 16.0);
    scene.box.samples_across = {5, 7};
    return scene;
}

SelftestScene reordered() {
    SelftestScene scene = base_scene("Tets, their corners and points in another order");
    scene.mesh = [](const LayeredBox& box) { return shuffled(kuhn_tets(box, 2), 7); };
    return scene;
}

SelftestScene refined() {
    SelftestScene scene = base_scene("The mesh refined by 400 points, the field unchanged");
    scene.mesh = [](const LayeredBox& box) { return split_tets(box, 400, .5, 11); };
    return scene;
}

SelftestScene twice_the_slabs() {
    SelftestScene scene = base_scene("Twice the slabs");
    *scene.scene.slice.samples *= 2;
    return scene;
}

}  // namespace

std::vector<SelftestCase> metamorphic_cases() {
    std::vector<SelftestCase> cases;
    const auto add = [&](const std::string& name, const SelftestScene& other,
                         const std::vector<std::string>& ways) {
        for (const std::string& way : ways)
            cases.push_back(
                same_picture_case(metamorphic_group, name, base_scene(), other, way_named(way)));
    };
    const std::vector<std::string> slices{"slice post float32", "slice preintegrated float32"};
    const std::vector<std::string> projections{"project float32", "project analytic float32"};
    std::vector<std::string> all = slices;
    all.insert(all.end(), projections.begin(), projections.end());
    add("translate", translated(), all);
    add("rotate", rotated(), all);
    add("scale_up", scaled(4096, "World and lengths 4096 times as large"), all);
    add("scale_down", scaled(0x1p-20, "World and lengths 2^20 times smaller"), all);
    add("stored_backwards", stored_backwards(), all);
    add("axes_exchanged", axes_exchanged(), all);
    add("split_pieces", split_pieces(), all);
    add("more_samples", more_samples(), all);
    add("double_slabs", twice_the_slabs(), slices);
    add("reorder_tets", reordered(), projections);
    add("refine_mesh", refined(), projections);
    return cases;
}

}  // namespace lamina::selftest
