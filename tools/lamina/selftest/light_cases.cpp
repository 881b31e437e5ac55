// SPDX-License-Identifier: Apache-2.0
// Lit boxes. In a box of one layer the gradient is the same everywhere, so light does the same to
// all of a ray; ambient light of 1 changes nothing in any box.
#include "selftest/case_makers.h"
#include "selftest/selftest_meshes.h"

namespace lamina::selftest {
namespace {

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

Lighting headlight() {
    Lighting lighting;
    lighting.smallest_gradient = .1;
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

// From where the eye is, the light shines towards it.
SelftestScene light_behind() {
    SelftestScene scene = orthographic("opposite_light",
                                       "A light straight towards the eye: no "
                                       "highlight",
                                       two_lights(.1));
    scene.scene.lighting->lights[0].direction =
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

std::vector<SelftestCase> light_cases() {
    std::vector<DrawingWay> ways = traces();
    ways.push_back(way_named("slice exact float32"));
    // The gradient has a length of .8.
    const SelftestScene scenes[] = {
        orthographic("directional", "Two lights, parallel rays: one factor for the picture",
                     two_lights(.1)),
        lit_scene("perspective", "Two lights, rays in perspective: one factor a ray",
                  two_lights(.1)),
        lit_scene("headlight", "A light at the eye", headlight()),
        lit_scene("half_lit", "A smallest gradient as long as the gradient", two_lights(.8)),
        lit_scene("steep", "A smallest gradient far below the gradient", two_lights(1e-100)),
        lit_scene("flat", "A smallest gradient far above the gradient", two_lights(1e100)),
        light_behind(),
        ambient_alone(),
    };
    std::vector<SelftestCase> cases;
    for (const SelftestScene& scene : scenes) {
        for (SelftestCase& each : cases_of("light", scene, ways)) cases.push_back(each);
    }
    return cases;
}

}  // namespace lamina::selftest
