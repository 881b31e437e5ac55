// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "gl/api.h"
#include "gl/context_counts.h"
#include "gl/program_cache.h"
#include "plan/capabilities.h"

namespace lamina::gl {

// any: a GPU through EGL where there is one, else OSMesa, else EGL with a software renderer.
// gpu: a GPU through EGL.
// egl: a GPU where there is one, else a software renderer.
enum class ContextKind { any, gpu, osmesa, egl };

// An OpenGL 4.5 core context without a window or a display server. Several may be there, each is
// current in one thread at a time (gl/current_context.h). Every object of this room belongs to the
// context that was current when it was made: that is current, too, when it is used and when it
// goes, and goes later.
class Context {
  public:
    // Makes a context. Throws Error, which says what was tried, why each attempt failed, and what
    // to install or to pass.
    static std::unique_ptr<Context> create(ContextKind kind);

    virtual ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const Capabilities& capabilities() const { return capabilities_; }
    ContextCounts& counts() { return counts_; }
    ProgramCache& programs() { return programs_; }

  protected:
    using LoadFunction = void (*(*)(const char* name))();

    Context();

    // To be called once the context can be made current: loads OpenGL's functions, fills the
    // capabilities and sets the state that the whole project relies on. `interface_name` goes in
    // front of GL_RENDERER.
    void initialise(LoadFunction load, const char* interface_name, bool software);

  private:
    friend class CurrentContext;
    friend const GladGLContext& api();

    // In this thread, in which the library has no other current one; an Error where it fails.
    virtual void bind() = 0;
    virtual void release() = 0;

    std::unique_ptr<GladGLContext> functions_;
    Capabilities capabilities_;
    ContextCounts counts_;
    ProgramCache programs_;
    std::atomic<std::thread::id> thread_{};  // whose CurrentContexts are there; none: nobody's
    int scopes_ = 0;                         // so many of them
};

}  // namespace lamina::gl
