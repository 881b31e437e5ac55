// SPDX-License-Identifier: Apache-2.0
#pragma once

// The two ways to make a context. Each throws Error with the reason where it fails.
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "gl/api.h"
#include "gl/program.h"
#include "plan/capabilities.h"

namespace lamina::gl {

// Of one context.
struct ContextCounts {
    std::int64_t bytes_allocated = 0;  // of buffers and textures, now
    std::int64_t bytes_uploaded = 0;   // to textures, until now
};

// any: a GPU through EGL where there is one, else OSMesa, else EGL with a software renderer.
// gpu: a GPU through EGL.
// egl: a GPU where there is one, else a software renderer.
enum class ContextKind { any, gpu, osmesa, egl };

// An OpenGL 4.5 core context without a window or a display server. Several may be there, each is
// current in one thread at a time (gl/context.h). Every object of this room belongs to the
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

    // In this thread, in which the library has no other current one; an Error if it fails.
    virtual void bind() = 0;
    virtual void release() = 0;

    std::unique_ptr<GladGLContext> functions_;
    Capabilities capabilities_;
    ContextCounts counts_;
    ProgramCache programs_;
    std::atomic<std::thread::id> thread_{};  // whose CurrentContexts are there; none: nobody's
    int scopes_ = 0;                         // so many of them
};

enum class EglDevices { hardware, any };

std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context(EglDevices devices);

// What a library has current in this thread, whoever made it; `context` is null if nothing is.
struct EglBinding {
    unsigned api = 0;  // that eglBindAPI() chose; 0 if EGL is not loaded
    void *display = nullptr, *draw = nullptr, *read = nullptr, *context = nullptr;
};
struct OsmesaBinding {
    void *context = nullptr, *buffer = nullptr;
    unsigned type = 0;  // of the buffer's components
    int width = 0, height = 0;
};

// They return what was current and is so no longer, and make it current again. They load nothing.
EglBinding release_egl();
void restore(const EglBinding& binding);
OsmesaBinding release_osmesa();
void restore(const OsmesaBinding& binding);

// A context is current in this thread while this lives, and what was current before it is so again
// afterwards: another context of this room, or one that the caller has made with EGL or OSMesa. Of
// GLX it knows nothing: where a context of GLX is current, the caller takes another thread.
// Scopes of a thread end in the reverse order of their beginnings.
class CurrentContext {
  public:
    // An Error if the context is current in another thread.
    explicit CurrentContext(Context& context);
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

  private:
    void take();
    void give_back() const;

    Context& context_;
    Context* const before_;  // of this room; null if none was current
    EglBinding egl_;         // of anybody, like the next
    OsmesaBinding osmesa_;
};

// Null where none of this room is.
Context* current_context();

}  // namespace lamina::gl
