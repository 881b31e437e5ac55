// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "gl/api.h"
#include "gl/program.h"
#include "plan/capabilities.h"

namespace lamina::gl {

struct ContextCounts {
    std::int64_t bytes_allocated = 0;  // those that buffers and textures hold now
    std::int64_t bytes_uploaded = 0;   // those that textures got so far
};

// any: a GPU through EGL, else OSMesa, else EGL with a software renderer. gpu: a GPU through EGL.
// egl: a GPU if there is one, else a software renderer.
enum class ContextKind { any, gpu, osmesa, egl };

// An OpenGL 4.5 core context without a window or a display server, current in one thread at a time
// (CurrentContext). Every object of this module belongs to the context that was current when it was
// made; that context must outlive it, and be current when it is used and destroyed.
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

    // Make the context current in this thread, which has no other, and end that. Throw Error.
    virtual void bind() = 0;
    virtual void release() = 0;

    std::unique_ptr<GladGLContext> functions_;
    Capabilities capabilities_;
    ContextCounts counts_;
    ProgramCache programs_;
    std::atomic<std::thread::id> thread_{};  // the thread in which it is current; none if nowhere
    int scopes_ = 0;                         // CurrentContexts that exist for it
};

enum class EglDevices { hardware, any };

std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context(EglDevices devices);

// The context that EGL (OSMesa) has current in this thread; `context` is null if there is none.
struct EglBinding {
    unsigned api = 0;  // the one that eglBindAPI() chose; 0 if EGL is not loaded
    void *display = nullptr, *draw = nullptr, *read = nullptr, *context = nullptr;
};
struct OsmesaBinding {
    void *context = nullptr, *buffer = nullptr;
    unsigned type = 0;  // type of the buffer's components
    int width = 0, height = 0;
};

// release_...() ends and returns what was current; restore() brings it back. No library is loaded.
EglBinding release_egl();
void restore(const EglBinding& binding);
OsmesaBinding release_osmesa();
void restore(const OsmesaBinding& binding);

// Makes a context current in this thread while it exists. Then the context before it is current
// again, whether of this module or of the caller's EGL or OSMesa; a caller with a context of GLX
// takes another thread. Scopes of a thread end in the reverse order of their beginnings.
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
    Context* const before_;  // the context of this module before; null if there was none
    EglBinding egl_;         // what EGL had current before, whoever made it
    OsmesaBinding osmesa_;
};

// Returns the context of this module that is current in this thread, or null.
Context* current_context();

}  // namespace lamina::gl
