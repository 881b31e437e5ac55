// SPDX-License-Identifier: Apache-2.0
// Stiff optics: optical depths from 1e-8 to 1e6, jumps, spikes, steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "selftest/case_makers.h"
#include "selftest/layered_box.h"

namespace lamina::selftest {
namespace {

constexpr const char* optics_group = "optics";

void append(std::vector<SelftestCase>& cases, std::vector<SelftestCase> more) {
    for (SelftestCase& each : more) cases.push_back(std::move(each));
}

void append_float_ways(std::vector<SelftestCase>& cases, const SelftestScene& scene) {
    append(cases, cases_of(optics_group, {scene}, traces()));
    append(cases, cases_of(optics_group, {scene}, float_ways()));
}

// Sets transfer function and max_error. `depth`: bound of the optical depths; faint pictures allow
// only small omissions.
void set_optics(SelftestScene& scene, const TransferFunction& transfer_function, double depth) {
    scene.scene.transfer_function = transfer_function;
    scene.scene.max_error = std::min(1.0, depth);
}

// Appends homogeneous boxes. Rays are 0 to 1.7 long, so optical depths vary.
void append_depths(std::vector<SelftestCase>& cases) {
    for (const double depth : {1e-8, 1e-4, 1., 30., 1e3, 1e6}) {
        SelftestScene scene = plain_scene(
            fmt::format("homogeneous_{:g}", depth),
            fmt::format("Extinction {:g} all over a unit box: optical depths up to 1.7 times that",
                        depth));
        set_optics(scene, optics_of({{0, {{.2, .6, 1}, depth}}}), depth);
        append_float_ways(cases, scene);
    }
    for (const double extinction : {1e-6, 1e4}) {
        SelftestScene scene = plain_scene(fmt::format("ramp_{:g}", extinction),
                                          fmt::format("Extinction 0 to {:g} along one axis, "
                                                      "colour turning from blue to red",
                                                      extinction));
        set_optics(scene, optics_of({{0, {{0, .1, 1}, 0}}, {1, {{1, .4, 0}, extinction}}}),
                   extinction);
        append_float_ways(cases, scene);
    }
}

// Appends jumps of extinction between samples. Samples are float32 numbers, which a volume holds
// exactly.
void append_jumps(std::vector<SelftestCase>& cases) {
    SelftestScene jump = plain_scene(
        "jump_1e8", "Extinction 1e-4 and 1e4 in turn, from one sample to the next, 16 layers");
    jump.box.samples.clear();
    for (int k = 0; k <= 16; ++k) jump.box.samples.push_back(k % 2);
    jump.scene.transfer_function = optics_of({{0, {{.9, .9, .9}, 1e-4}}, {1, {{.9, .9, .9}, 1e4}}});
    append_float_ways(cases, jump);

    SelftestScene sheet = plain_scene(
        "opaque_sheet", "One sample of 33 is opaque (extinction 1e7), the others faint");
    sheet.box.samples.assign(33, 0);
    sheet.box.samples[13] = 1;
    sheet.scene.transfer_function = optics_of({{0, {{.2, .4, .6}, .1}}, {1, {{.2, .4, .6}, 1e7}}});
    append_float_ways(cases, sheet);
}

void append_opacities(std::vector<SelftestCase>& cases) {
    // Opacity 1 in a scene file means extinction 1e7 per unit length (docs/scene.md).
    const std::pair<const char*, double> opacities[] = {
        {"opacity_1", 1e7}, {"opacity_1_less_1e-12", -std::log(1e-12)}, {"opacity_1e-12", 1e-12}};
    for (const auto& [name, extinction] : opacities) {
        SelftestScene scene = plain_scene(
            name, fmt::format("Opacity over one unit of length: extinction {:g}", extinction));
        set_optics(scene,
                   optics_of({{.25, {{1, .5, .25}, 0}},
                              {.5, {{1, .5, .25}, extinction}},
                              {.75, {{1, .5, .25}, 0}}}),
                   extinction);
        append_float_ways(cases, scene);
    }
}

void append_spikes(std::vector<SelftestCase>& cases) {
    SelftestScene spike = plain_scene(
        "spike_1e-4", "A peak of width 1e-4 of the scalars, extinction 1e4: a sheet of depth .5");
    spike.scene.transfer_function = optics_of(
        {{.49995, {{1, .8, .2}, 0}}, {.5, {{1, .8, .2}, 1e4}}, {.50005, {{1, .8, .2}, 0}}});
    append_float_ways(cases, spike);

    SelftestScene steps = plain_scene(
        "steps", "Two points at one value, three times: nothing, faint, dense, nothing");
    steps.scene.transfer_function = optics_of({{.25, {{.7, .7, .7}, 0}},
                                               {.25, {{.7, .7, .7}, .5}},
                                               {.5, {{.7, .7, .7}, .5}},
                                               {.5, {{.7, .7, .7}, 50}},
                                               {.75, {{.7, .7, .7}, 50}},
                                               {.75, {{.7, .7, .7}, 0}}});
    append_float_ways(cases, steps);
}

void append_targets(std::vector<SelftestCase>& cases) {
    SelftestScene faint = plain_scene("targets_faint", "A ramp of optical depth up to .4");
    faint.scene.transfer_function = optics_of({{0, {{.3, .6, .9}, .05}}, {1, {{.3, .6, .9}, .3}}});
    SelftestScene dense = plain_scene("targets_dense", "A ramp of optical depth up to 1000");
    dense.scene.transfer_function = optics_of({{0, {{.3, .6, .9}, 0}}, {1, {{.3, .6, .9}, 1e3}}});
    SelftestScene colored = plain_scene("targets_colored", "Colours from blue to red");
    colored.scene.transfer_function = optics_of({{0, {{0, .1, 1}, 1}}, {1, {{1, .4, 0}, 3}}});
    std::vector<SelftestScene> scenes{faint, dense, colored};
    for (SelftestScene& scene : scenes) scene.scene.slice.samples = 16;
    append(cases, cases_of(optics_group, scenes, coarse_ways()));
    for (SelftestScene& scene : scenes) scene.scene.slice.samples = 64;
    append(cases, cases_of(optics_group, scenes, tree_ways()));
}

SelftestScene lit_scene(const std::string& name, const std::string& about,
                        const Lighting& lighting) {
    SelftestScene scene = plain_scene(name, about);
    scene.box.edges = {{{1, 0, 0}, {0, .8, 0}, {0, 0, 1.25}}};
    scene.scene.transfer_function =
        optics_of({{0, {{.9, .5, .2}, .2}}, {.5, {{.3, 1, .4}, 2}}, {1, {{.2, .5, .9}, 4}}});
    scene.scene.camera = camera_at(scene.box, 1.5, 40);
    scene.mesh = [](const LayeredBox& box) { return kuhn_tets(box, 2); };
    scene.scene.lighting = lighting;
    return scene;
}

Lighting two_lights(double smallest_gradient) {
    Lighting lighting;
    lighting.ambient = .25;
    lighting.diffuse = .5;
    lighting.specular = .5;
    lighting.power = 7.5;
    lighting.smallest_gradient = smallest_gradient;
    lighting.lights = {{glm::dvec3(.4, .9, .6), {1, .5, .25}},
                       {glm::dvec3(-.7, .1, .5), {.25, .5, 1}}};
    return lighting;
}

SelftestScene orthographic(const std::string& name, const std::string& about,
                           const Lighting& lighting) {
    SelftestScene scene = lit_scene(name, about, lighting);
    Camera& camera = *scene.scene.camera;
    camera.projection = Projection::orthographic;
    camera.height = 1.9;
    return scene;
}

SelftestScene light_behind() {
    SelftestScene scene = orthographic(
        "opposite_light", "A light straight towards the eye: no highlight", two_lights(.1));
    (*scene.scene.lighting)->lights[0].direction =
        scene.scene.camera->center - scene.scene.camera->eye;
    return scene;
}

SelftestScene ambient_alone() {
    Lighting lighting = two_lights(.1);
    lighting.ambient = 1;
    lighting.diffuse = lighting.specular = 0;
    SelftestScene scene =
        lit_scene("ambient", "Ambient light of 1 alone is no light at all", lighting);
    scene.box.samples = {0, 1, .5, .75, 0};
    return scene;
}

}  // namespace

std::vector<SelftestCase> optics_cases() {
    std::vector<SelftestCase> cases;
    append_depths(cases);
    append_jumps(cases);
    append_opacities(cases);
    append_spikes(cases);
    append_targets(cases);
    return cases;
}

// Lit boxes. In a box of one layer the gradient is constant, so light changes all of a ray in the
// same manner; ambient light of 1 alone changes nothing in any box.

std::vector<SelftestCase> light_cases() {
    // The gradient has a length of .8.
    const std::vector<SelftestScene> scenes{
        orthographic("directional", "Two lights, parallel rays: one factor for the picture",
                     two_lights(.1)),
        lit_scene("perspective", "Two lights, rays in perspective: one factor a ray",
                  two_lights(.1)),
        lit_scene("headlight", "A light at the eye", Lighting{.smallest_gradient = .1}),
        lit_scene("half_lit", "A smallest gradient as long as the gradient", two_lights(.8)),
        lit_scene("steep", "A smallest gradient far below the gradient", two_lights(1e-100)),
        lit_scene("flat", "A smallest gradient far above the gradient", two_lights(1e100)),
        light_behind(),
        ambient_alone(),
    };
    return cases_of("light", scenes, traces_and({"slice exact float32"}));
}

}  // namespace lamina::selftest
