// SPDX-License-Identifier: Apache-2.0
#include "executors/gl_compositing.h"

#include <glad/gl.h>

#include <cmath>

#include "base/enum_words.h"
#include "compositing/codes.h"
#include "gl/api.h"

namespace lamina {

gl::TextureFormat color_format(const CompositingPlan& plan) {
    switch (plan.target) {
        case Target::float32:
            return gl::TextureFormat::rgba32f;
        case Target::float16:
            return gl::TextureFormat::rgba16f;
        case Target::fixed16:
        case Target::fixed8:
        case Target::emulated:
            return plan.code_bits() > 8 ? gl::TextureFormat::rgba16 : gl::TextureFormat::rgba8;
    }
    unreachable_enum();
}

gl::TextureFormat opacity_format(const CompositingPlan& plan) {
    switch (plan.target) {
        case Target::float32:
            return gl::TextureFormat::r32f;
        case Target::float16:
            return gl::TextureFormat::r16f;
        case Target::fixed16:
        case Target::fixed8:
        case Target::emulated:
            return plan.code_bits() > 8 ? gl::TextureFormat::r16 : gl::TextureFormat::r8;
    }
    unreachable_enum();
}

void set_compositing(gl::Defines& defines, const CompositingPlan& plan) {
    defines.set("BITS", plan.code_bits());
    if (!plan.emulation) return;
    defines.set("EMULATED", 1);
    defines.set("ALPHA_ROUNDING", static_cast<int>(plan.emulation->alpha));
    if (plan.emulation->over == OverRounding::fused) defines.set("OVER_FUSED", 1);
    if (plan.order == Order::front_to_back) defines.set("FRONT_TO_BACK", 1);
    if (plan.blending == Blending::fetch) defines.set("FRAMEBUFFER_FETCH", 1);
}

CompositingState::CompositingState(const CompositingPlan& plan, bool opacity_only,
                                   const gl::Framebuffer& target)
    : native_(plan.blending == Blending::native) {
    if (plan.blending == Blending::barrier) target.color().bind(target_unit);
    if (!native_) return;
    gl::api().Enable(GL_BLEND);
    if (plan.order == Order::back_to_front) {
        gl::api().BlendFunc(GL_ONE, opacity_only ? GL_ONE_MINUS_SRC_COLOR : GL_ONE_MINUS_SRC_ALPHA);
    } else {
        gl::api().BlendFunc(opacity_only ? GL_ONE_MINUS_DST_COLOR : GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    }
}

CompositingState::~CompositingState() {
    if (native_) gl::api().Disable(GL_BLEND);
}

void decode(Image& image, const CompositingPlan& plan) {
    const double largest = largest_code(plan.code_bits());
    const double stored = plan.code_bits() > 8 ? 65535 : 255;
    for (float& value : image.rgba)
        value = static_cast<float>(std::round(static_cast<double>(value) * stored) / largest);
}

void finish_layer(const CompositingPlan& plan) {
    if (plan.blending == Blending::barrier) gl::api().TextureBarrier();
}

}  // namespace lamina
