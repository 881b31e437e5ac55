// SPDX-License-Identifier: Apache-2.0
#include "selftest/picture_maker.h"

#include <algorithm>
#include <memory>

#include "projection/project_renderer.h"
#include "reference/scene_tracer.h"
#include "render/scene_renderer.h"

namespace lamina::selftest {
PreciseImage PictureMaker::draw(const Scene& scene, const Volume& volume) const {
    if (scene.method == Method::trace) return trace(scene, volume).image;
    SceneRenderer frames(scene, std::make_shared<const VolumeData>(volume), capabilities_);
    return to_double(frames.draw_picture());
}

PreciseImage PictureMaker::draw(const Scene& scene, const SceneMesh& mesh,
                                OrderReport* order) const {
    if (scene.method == Method::trace) return trace(scene, mesh).image;
    // The mesh is the caller's, and outlives the renderer.
    SceneRenderer frames(scene, std::shared_ptr<const SceneMesh>(std::shared_ptr<void>(), &mesh),
                         capabilities_);
    frames.draw();
    if (order) *order = dynamic_cast<const ProjectRenderer&>(frames.renderer()).order_report();
    return to_double(frames.picture());
}

}  // namespace lamina::selftest
