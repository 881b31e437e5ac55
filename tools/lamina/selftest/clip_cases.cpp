// SPDX-License-Identifier: Apache-2.0
// Boxes that planes cut: rays end where they meet the planes, and are otherwise as in whole boxes.
#include <glm/geometric.hpp>

#include "selftest/case_makers.h"
#include "selftest/selftest_meshes.h"

namespace lamina::selftest {
namespace {

SelftestScene cut_scene(const std::string& name, const std::string& about,
                        const std::vector<ClipPlane>& planes) {
    SelftestScene scene = plain_scene(name, about);
    scene.box.edges = {{{1, 0, 0}, {0, .8, 0}, {0, 0, 1.2}}};
    scene.box.samples = {0, 1, .5, .75, 0};
    scene.scene.transfer_function =
        optics_of({{0, {{.9, .5, .2}, .2}}, {.5, {{.3, 1, .4}, 2}}, {1, {{.2, .5, .9}, 4}}});
    scene.scene.camera = camera_at(scene.box, 1.5, 40);
    scene.mesh = [](const LayeredBox& box) { return kuhn_tets(box, 2); };
    scene.box.cuts = planes;
    scene.scene.clip.planes = planes;
    return scene;
}

// Both ends of a box of the clip on each axis.
SelftestScene cut_by_box() {
    const glm::dvec3 lo(.2, .1, .3), hi(.7, .6, 1.1);
    SelftestScene scene = cut_scene("clip_box", "A box of the clip inside the box", {});
    scene.scene.clip.box = ClipBox{lo, hi};
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0);
        normal[axis] = 1;
        scene.box.cuts.push_back({lo, normal});
        scene.box.cuts.push_back({hi, -normal});
    }
    return scene;
}

SelftestScene seen_from_inside() {
    SelftestScene scene = cut_scene("eye_in_cut", "The eye in the part that is cut away",
                                    {{{.5, .4, .6}, {.2, -.3, -1}}});
    scene.scene.camera->eye = {.45, .4, 1};
    scene.scene.camera->center = {.5, .35, .2};
    scene.scene.camera->fov_y = 70;
    return scene;
}

std::vector<SelftestScene> all_clips() {
    const glm::dvec3 middle(.5, .4, .6), oblique(.3, -.5, .8);
    std::vector<SelftestScene> scenes;
    const auto add = [&](const std::string& name, const std::string& about,
                         const std::vector<ClipPlane>& planes) {
        scenes.push_back(cut_scene(name, about, planes));
    };
    add("oblique", "A plane through the middle", {{middle, oblique}});
    add("wedge", "Two planes that meet in the box", {{middle, oblique}, {middle, {1, .2, -.1}}});
    add("thin_slice", "What is left is a thousandth of the box thick",
        {{middle, oblique}, {middle + 1e-3 * glm::normalize(oblique), -oblique}});
    add("between_layers", "A plane where two layers meet", {{{0, 0, .6}, {0, 0, -1}}});
    add("through_corners", "A plane through four corners of the box", {{{0, 0, 0}, {.8, 1, 0}}});
    add("diagonal", "A plane through an edge and the edge across", {{{1, 0, 0}, {.8, 1, 0}}});
    add("nothing_cut", "A plane beside the box", {{{0, 0, -.1}, {0, 0, 1}}});
    add("all_cut", "A plane that hides all", {{{0, 0, 1.3}, {.1, 0, 1}}});
    scenes.push_back(cut_by_box());
    scenes.push_back(seen_from_inside());
    SelftestScene parallel =
        cut_scene("orthographic", "Parallel rays along the plane", {{middle, {1, 0, .5}}});
    parallel.scene.camera->projection = Projection::orthographic;
    parallel.scene.camera->height = 1.9;
    parallel.scene.camera->eye = parallel.scene.camera->center + glm::dvec3(-1.5, .1, 3);
    scenes.push_back(parallel);
    return scenes;
}

}  // namespace

std::vector<SelftestCase> clip_cases() {
    std::vector<DrawingWay> ways = traces();
    for (const char* name : {"slice post float32", "slice preintegrated float32",
                             "slice exact float32", "project float32", "project analytic float32"})
        ways.push_back(way_named(name));
    std::vector<SelftestCase> cases;
    for (const SelftestScene& scene : all_clips()) {
        for (SelftestCase& each : cases_of("clips", scene, ways)) cases.push_back(each);
    }
    return cases;
}

}  // namespace lamina::selftest
