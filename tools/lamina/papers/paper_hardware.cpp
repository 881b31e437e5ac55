// SPDX-License-Identifier: Apache-2.0
#include "papers/paper_hardware.h"

namespace lamina::papers {

Scene with_paper_hardware(Scene scene) {
    scene.target = Target::emulated;
    scene.emulate = Emulation{};  // 8 bits, truncate, separate
    return scene;
}

ErrorNorms channel_error(const Image& image, const Image& exact, std::size_t channel) {
    return image_error(image, exact).of_channel[channel];
}

}  // namespace lamina::papers
