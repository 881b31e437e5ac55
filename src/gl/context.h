// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>
#include <thread>

#include "gl/api.h"
#include "gl/program.h"
#include "plan/capabilities.h"

namespace lamina::gl {

// Memory and uploads of a context.
struct ContextCounts {
    std::int64_t bytes_allocated = 0;  // bytes of the buffers and textures that exist now
    // Bytes uploaded to textures and buffers so far, without those written to mapped buffers.
    std::int64_t bytes_uploaded = 0;
};

// any: a GPU (EGL), else OSMesa, else software EGL. gpu: a GPU (EGL). egl: a GPU, else software.
enum class ContextKind { any, gpu, osmesa, egl };

// An OpenGL 4.5 core context without window or display server, current in one thread at a time. It
// must outlive this module's objects made in it, and be current when they are used or destroyed.
class Context {
  public:
    // Makes a context. Throws Error: why each attempt failed, and what to install or pass.
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

    // Must be called once the context can be made current. Loads OpenGL's functions, fills the
    // capabilities, and sets the common state. `interface_name` goes in front of GL_RENDERER.
    void initialise(LoadFunction load, const char* interface_name, bool software);

  private:
    friend class CurrentContext;
    friend const GladGLContext& api();

    // bind() makes the context current in this thread, which must have no current context;
    // release() undoes this. Both throw Error.
    virtual void bind() = 0;
    virtual void release() = 0;

    std::unique_ptr<GladGLContext> functions_;
    Capabilities capabilities_;
    ContextCounts counts_;
    ProgramCache programs_;
    std::atomic<std::thread::id> thread_{};  // the thread in which it is current; none if nowhere
    int scopes_ = 0;                         // number of CurrentContext objects that exist for it
};

// EGL devices that may be used: GPUs only, or also software renderers.
enum class EglDevices { hardware, any };

std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context(EglDevices devices);

// The state of EGL (of OSMesa) in this thread: the current context, or null, and its surfaces.
struct EglBinding {
    unsigned api = 0;  // the API that eglBindAPI() chose; 0 if EGL is not loaded
    void *display = nullptr, *draw = nullptr, *read = nullptr, *context = nullptr;
};
struct OsmesaBinding {
    void *context = nullptr, *buffer = nullptr;
    unsigned type = 0;  // type of the buffer's components
    int width = 0, height = 0;
};

// Functions release_...() leave the thread without a current context and return the state before;
// restore() makes that state's context current again. None of them loads a library.
EglBinding release_egl();
void restore(const EglBinding& binding);
OsmesaBinding release_osmesa();
void restore(const OsmesaBinding& binding);

// Makes a context current in this thread during its lifetime, then again the previous one, of this
// module or of the caller's EGL or OSMesa. Callers with a current GLX context must use another
// thread. Objects of one thread must end in the reverse order of their beginnings.
class CurrentContext {
  public:
    // Throws Error if the context is current in another thread.
    explicit CurrentContext(Context& context);
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

  private:
    void take();
    void give_back() const;

    Context& context_;
    Context* const before_;  // the previous context of this module; null if there was none
    EglBinding egl_;         // EGL's state before, whoever made its context
    OsmesaBinding osmesa_;
};

// Returns the context of this module that is current in this thread, or null.
Context* current_context();

// Tells whether the current context has an extension, such as "GL_ARB_shader_clock".
bool has_extension(std::string_view name);

}  // namespace lamina::gl
