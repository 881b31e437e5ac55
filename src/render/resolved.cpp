// SPDX-License-Identifier: Apache-2.0
#include "render/resolved.h"

#include <cassert>

namespace lamina {
namespace {

class OpenKeys {
  public:
    template <typename T>
    void add(const char* key, const Auto<T>& value) {
        if (value.is_automatic()) keys.emplace_back(key);
    }

    std::vector<std::string> keys;
};

void add_slice(const SliceSettings& slice, OpenKeys& open) {
    open.add("render.slice.samples", slice.samples);
    open.add("render.slice.classification", slice.classification);
    open.add("render.slice.filter", slice.filter);
    if (slice.dither) open.add("render.slice.dither.period", slice.dither->period);
    if (slice.tree) open.add("render.slice.tree", *slice.tree);
}

void add_project(const ProjectSettings& project, OpenKeys& open) {
    if (!project.tree) open.add("render.project.order", project.order);
    open.add("render.project.geometry", project.geometry);
    if (project.tree) open.add("render.project.tree", *project.tree);
}

}  // namespace

std::vector<std::string> open_keys(const Scene& scene) {
    OpenKeys open;
    open.add("transfer_function", scene.transfer_function);
    open.add("camera", scene.camera);
    if (scene.lighting) open.add("lighting.smallest_gradient", scene.lighting->smallest_gradient);
    if (scene.method != Method::trace) open.add("render.target", scene.target);
    if (scene.method == Method::slice) add_slice(scene.slice, open);
    if (scene.method == Method::project) add_project(scene.project, open);
    return std::move(open.keys);
}

Resolved::Resolved(Scene scene) : scene_(std::move(scene)) {
    assert(open_keys(scene_).empty());
}

}  // namespace lamina
