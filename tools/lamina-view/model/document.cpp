// SPDX-License-Identifier: Apache-2.0
#include "model/document.h"

#include <utility>

namespace lamina::view {

void Document::open(Scene scene) {
    scene_ = std::move(scene);
    ++revisions_.data;
    dirty_ = false;
}

void Document::set_camera(const Camera& camera) {
    scene_.camera = camera;
    scene_.automatic_camera = false;
    ++revisions_.camera;
    dirty_ = true;
}

void Document::set_transfer_function(const TransferFunction& transfer_function) {
    scene_.transfer_function = transfer_function;
    scene_.automatic_transfer_function = false;
    ++revisions_.transfer_function;
    dirty_ = true;
}

void Document::set_clip(const Clip& clip) {
    scene_.clip = clip;
    ++revisions_.clip;
    dirty_ = true;
}

void Document::set_size(int width, int height) {
    if (width == scene_.width && height == scene_.height) return;
    scene_.width = width;
    scene_.height = height;
    ++revisions_.size;
}

void Document::edit(const std::function<void(Scene&)>& change) {
    change(scene_);
    ++revisions_.settings;
    dirty_ = true;
}

void Document::take_chosen(const Scene& chosen) {
    if (scene_.automatic_camera) scene_.camera = chosen.camera;
    if (scene_.automatic_transfer_function) scene_.transfer_function = chosen.transfer_function;
    scene_.automatic_camera = scene_.automatic_transfer_function = false;
}

}  // namespace lamina::view
