// SPDX-License-Identifier: Apache-2.0
#include "gl/current_context.h"

#include <cassert>

#include "base/error.h"
#include "gl/api.h"

namespace lamina::gl {
namespace {

thread_local Context* current_of_thread = nullptr;

}  // namespace

Context* current_context() {
    return current_of_thread;
}

const GladGLContext& api() {
    assert(current_of_thread != nullptr);
    return *current_of_thread->functions_;
}

CurrentContext::CurrentContext(Context& context) : context_(context), before_(current_of_thread) {
    std::thread::id owner;
    const std::thread::id self = std::this_thread::get_id();
    if (!context_.thread_.compare_exchange_strong(owner, self) && owner != self)
        fail("OpenGL: this context is current in another thread");
    ++context_.scopes_;
    if (before_ == &context_) return;
    try {
        take();
    } catch (const Error&) {
        give_back();
        throw;
    }
    current_of_thread = &context_;
}

// EGL's context goes first, because Mesa's EGL and OSMesa share one notion of what is current:
// OSMesa would take a context of EGL for one of its own.
void CurrentContext::take() {
    egl_ = release_egl();
    osmesa_ = release_osmesa();
    context_.bind();
}

CurrentContext::~CurrentContext() {
    assert(current_of_thread == &context_);
    if (before_ != &context_) context_.release();
    current_of_thread = before_;
    give_back();
}

void CurrentContext::give_back() const {
    restore(osmesa_);
    restore(egl_);
    if (--context_.scopes_ == 0) context_.thread_ = std::thread::id();
}

}  // namespace lamina::gl
