// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/context.h"
#include "gl/context_backends.h"

namespace lamina::gl {

// A context is current in this thread while this lives, and what was current before it is so again
// afterwards: another context of this room, or one that the caller has made with EGL or OSMesa. Of
// GLX it knows nothing: where a context of GLX is current, the caller takes another thread.
// Scopes of a thread end in the reverse order of their beginnings.
class CurrentContext {
  public:
    // An Error where the context is current in another thread.
    explicit CurrentContext(Context& context);
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

  private:
    void take();
    void give_back() const;

    Context& context_;
    Context* const before_;  // of this room; null where none was current
    EglBinding egl_;         // of anybody, like the next
    OsmesaBinding osmesa_;
};

// Null where none of this room is.
Context* current_context();

}  // namespace lamina::gl
