// SPDX-License-Identifier: Apache-2.0
#include "render/frames.h"

#include <utility>

namespace lamina {

void Frames::set_size(int width, int height) {
    Scene changed = scene();
    changed.width = width;
    changed.height = height;
    set_scene(std::move(changed));
}

void Frames::set_transfer_function(const TransferFunction& transfer_function) {
    Scene changed = scene();
    changed.transfer_function = transfer_function;
    set_scene(std::move(changed));
}

void Frames::set_clip(const Clip& clip) {
    Scene changed = scene();
    changed.clip = clip;
    set_scene(std::move(changed));
}

}  // namespace lamina
