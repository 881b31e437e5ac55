// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "plan/capabilities.h"

namespace lamina::gl {

// automatic: a GPU through EGL where there is one, else OSMesa, else EGL with a software renderer.
// gpu: a GPU through EGL.
// egl: a GPU where there is one, else a software renderer.
enum class ContextKind { automatic, gpu, osmesa, egl };

// An OpenGL 4.5 core context without a window or a display server. It is current in the thread that
// made it. Only one exists at a time. All objects of this room belong to it and must be destroyed
// before it.
class Context {
  public:
    // Makes a context. Throws Error, which says what was tried, why each attempt failed, and what
    // to install or to pass.
    static std::unique_ptr<Context> create(ContextKind kind);

    virtual ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const Capabilities& capabilities() const { return capabilities_; }

  protected:
    using LoadFunction = void (*(*)(const char* name))();

    Context();

    // Must be called once the context is current. Loads OpenGL's functions, fills the capabilities
    // and sets the state that the whole project relies on. `interface_name` is put in front of
    // GL_RENDERER.
    void initialise(LoadFunction load, const char* interface_name, bool software);

  private:
    Capabilities capabilities_;
};

}  // namespace lamina::gl
