// SPDX-License-Identifier: Apache-2.0
// Scenes for the tests of the slicing renderer, and functions that draw them with OpenGL and with
// the tracer.
#pragma once

#include <algorithm>
#include <functional>
#include <string>

#include "gl/gl_fixture.h"
#include "image/difference.h"
#include "lamina/image.h"
#include "plan/plan.h"
#include "reference/fixtures.h"
#include "reference/tracer.h"
#include "slicing/gl_slice_renderer.h"
#include "support/transfer_functions.h"
#include "volume/generate.h"

namespace lamina {

using SlicingTest = gl::GlTest;

inline OmissionSwitch leave_nothing_out() {
    OmissionSwitch omissions;
    omissions.none = true;
    return omissions;
}

inline OmissionSwitch keep(const std::string& name) {
    OmissionSwitch omissions;
    omissions.kept = {name};
    return omissions;
}

inline Image render(const Volume& volume, const Scene& scene, const Capabilities& capabilities,
                    const OmissionSwitch& omissions = {}) {
    const Facts facts = measure(scene, volume, measure_bricks(volume));
    const Plan plan = make_plan(scene, facts, capabilities, omissions);
    GlSliceRenderer renderer(volume, *scene.transfer_function, facts, plan.slice, capabilities,
                             scene.width, scene.height);
    renderer.draw(View(*scene.camera, scene.width, scene.height));
    return renderer.read();
}

inline Image trace(const Volume& volume, const Scene& scene, double tolerance) {
    return to_float(
        trace_volume(volume, *scene.transfer_function,
                     View(*scene.camera, scene.width, scene.height),
                     {tolerance, copied_lighting(scene.lighting), half_spaces(scene.clip)})
            .image);
}

// Returns the largest difference, in 1/255.
inline double linf(const Image& a, const Image& b) {
    return image_error(a, b).all.linf;
}

// Returns the largest error of a homogeneous box's opacity, as docs/precision.md promises: relative
// 1e-4 for faint boxes, 1e-5 of full scale for others, and more for deep ones, because the depth
// multiplies the chord's rounding to float32.
inline double chord_bound(double depth) {
    return std::min(1e-4 * depth, 1e-5 * std::max(1.0, depth));
}

inline Volume gaussians(std::int64_t edge) {
    return generate({"gaussians", std::array{edge, edge, edge}, SampleType::float32});
}

using test::knot;

inline TransferFunction smooth_transfer_function() {
    return TransferFunction::linear({knot(0, {.1, .2, .6}, 0), knot(.25, {.2, .7, .5}, .8),
                                     knot(.5, {.8, .7, .2}, 2.5), knot(1, {1, .2, .1}, 6)});
}

// Returns a scene that looks at the unit box from outside, at an oblique angle.
inline Scene unit_box_scene(const TransferFunction& transfer_function, Projection projection,
                            int width = 64, int height = 48) {
    Scene scene;
    scene.slice.classification = Classification::post;
    scene.transfer_function = transfer_function;
    scene.camera->projection = projection;
    scene.camera->eye = {1.7, -.9, 1.3};
    scene.camera->center = {.5, .5, .5};
    scene.camera->up = {.1, .05, 1};
    scene.camera->fov_y = 50;
    scene.camera->height = 1.7;
    scene.width = width;
    scene.height = height;
    return scene;
}

}  // namespace lamina
