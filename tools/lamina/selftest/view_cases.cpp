// SPDX-License-Identifier: Apache-2.0
// Extreme views: angles, distances, eyes on and in the box, pictures of one pixel and of one row;
// clips; and scenes of many slabs, whose sums must not drift.
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "selftest/case_makers.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {
namespace {

SelftestScene view_scene(const std::string& name, const std::string& about) {
    SelftestScene scene = plain_scene(name, about);
    scene.box.edges = {{{1, 0, 0}, {0, .8, 0}, {0, 0, 1.2}}};
    scene.box.samples = {0, 1, .5, .75, 0};
    scene.scene.transfer_function = optics_of({{0, {{.9, .5, .2}, .2}}, {1, {{.9, .5, .2}, 3}}});
    scene.scene.camera = camera_at(scene.box, 1.5, 40);
    scene.mesh = [](const LayeredBox& box) { return kuhn_tets(box, 2); };
    return scene;
}

SelftestScene looking(const std::string& name, const std::string& about, const glm::dvec3& eye,
                      const glm::dvec3& at, double fov_y) {
    SelftestScene scene = view_scene(name, about);
    scene.scene.camera->eye = scene.box.world(eye);
    scene.scene.camera->center = scene.box.world(at);
    scene.scene.camera->fov_y = fov_y;
    return scene;
}

SelftestScene cut_scene(const std::string& name, const std::string& about,
                        const std::vector<ClipPlane>& planes) {
    SelftestScene scene = view_scene(name, about);
    scene.scene.transfer_function =
        optics_of({{0, {{.9, .5, .2}, .2}}, {.5, {{.3, 1, .4}, 2}}, {1, {{.2, .5, .9}, 4}}});
    scene.box.cuts = planes;
    scene.scene.clip.planes = planes;
    return scene;
}

// Returns a box that a box of the clip cuts at both ends of each axis.
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

std::vector<SelftestCase> view_cases() {
    std::vector<SelftestScene> scenes;
    for (const double angle : {1., 10., 90., 170.}) {
        SelftestScene scene = view_scene(fmt::format("fov_{:g}", angle),
                                         fmt::format("A field of view of {:g} degrees", angle));
        scene.scene.camera = camera_at(scene.box, angle < 90 ? 20 / angle : .55, angle);
        if (angle > 90) {  // at 45 degrees off the axis the picture shows only 1/11 of its width
            scene.scene.width = 96;
            scene.scene.height = 72;
        }
        scenes.push_back(scene);
    }
    const glm::dvec3 in{.52, .47, .51};
    scenes.push_back(looking("eye_inside", "The eye inside the box", {.3, .6, .4}, in, 60));
    scenes.push_back(
        looking("eye_inside_wide", "The eye inside, 170 degrees", {.3, .6, .4}, in, 170));
    scenes.push_back(looking("eye_on_vertex", "The eye on a corner of the mesh inside the box",
                             {.5, .5, .5}, {.9, .8, .7}, 60));
    SelftestScene hub = looking("eye_on_hub",
                                "The eye on a point that all tets share: the near "
                                "plane cuts every one",
                                {.5, .5, .5}, {.9, .8, .7}, 60);
    hub.box.samples = {0, 1};
    hub.mesh = [](const LayeredBox& box) { return fan_tets(box, 5); };
    scenes.push_back(hub);
    scenes.push_back(looking("eye_on_corner", "The eye on the box's corner", {0, 0, 0}, in, 60));
    scenes.push_back(
        looking("eye_on_edge", "The eye on an edge of the mesh", {.5, .25, .5}, {.9, .8, .7}, 60));
    scenes.push_back(looking("eye_in_face", "The eye in a face of the box", {.3, .4, 0}, in, 60));
    scenes.push_back(looking("eye_1e-6", "The eye 1e-6 in front of a face, looking along it",
                             {.3, .4, -1e-6}, {.9, .6, .1}, 60));
    scenes.push_back(
        looking("eye_1e-6_inside", "The eye 1e-6 behind a face", {.3, .4, 1e-6}, {.9, .6, .3}, 60));
    SelftestScene far = view_scene("eye_1e6", "The eye 1e6 box lengths away");
    far.scene.camera = camera_at(far.box, 1e6, 5.5e-5);
    scenes.push_back(far);
    SelftestScene small =
        view_scene("box_in_a_pixel", "The box far smaller than a pixel, in the middle of one");
    small.scene.camera = camera_at(small.box, 1e4, 40);
    small.scene.width = 5;
    small.scene.height = 3;
    scenes.push_back(small);
    SelftestScene one = view_scene("image_1x1", "A picture of one pixel");
    one.scene.width = one.scene.height = 1;
    scenes.push_back(one);
    SelftestScene row = view_scene("image_16384x1", "A picture of one row of 16384 pixels");
    row.scene.width = 16384;
    row.scene.height = 1;
    row.scene.slice.samples = 16;
    row.scene.camera = camera_at(row.box, 1.5, .01);
    scenes.push_back(row);
    scenes.push_back(
        looking("box_behind", "The box behind the eye", {.5, .5, -3}, {.5, .5, -5}, 60));
    for (const auto& [name, direction] : {std::pair{"along_axis", glm::dvec3(0, 0, -1)},
                                          {"along_edges", glm::dvec3(-1, -.8, -1.2)},
                                          {"oblique", glm::dvec3(-.7, .2, -.4)}}) {
        SelftestScene scene = view_scene(fmt::format("orthographic_{}", name),
                                         "Parallel rays, also along edges and faces of the mesh");
        Camera& camera = *scene.scene.camera;
        camera.projection = Projection::orthographic;
        camera.height = 1.9;
        camera.eye = camera.center - 3.0 * direction;
        scenes.push_back(scene);
    }
    return cases_of("views", scenes,
                    traces_and({"slice post float32", "slice preintegrated float32",
                                "project float32", "project analytic float32"}));
}

std::vector<SelftestCase> clip_cases() {
    return cases_of(
        "clips", all_clips(),
        traces_and({"slice post float32", "slice preintegrated float32", "slice exact float32",
                    "project float32", "project analytic float32"}));
}

std::vector<SelftestCase> depth_cases() {
    std::vector<SelftestCase> cases;
    const auto add = [&](const SelftestScene& scene, const std::vector<DrawingWay>& ways) {
        for (SelftestCase& each : cases_of("depth", {scene}, ways)) cases.push_back(each);
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
