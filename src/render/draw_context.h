// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "gl/context.h"
#include "lamina/settings.h"
#include "plan/capabilities.h"

namespace lamina {

const char* name_of(ContextChoice choice);

// Tells whether `word` names a context or is "auto".
bool is_context(const std::string& word);
// Returns the words that is_context() accepts, for messages.
std::string context_words();
// Returns the choice of a word. Throws UsageError if the word is unknown.
Auto<ContextChoice> context_choice(const std::string& word);

// Restricts the cpu engine to the instruction set that the environment variable LAMINA_INSTRUCTIONS
// names, if it is set: tests compare the instruction sets. Throws UsageError if the machine does
// not have these instructions.
void restrict_instructions_as_asked();

// The context that draws pictures: an OpenGL context, or the cpu engine, for which no OpenGL
// library is loaded.
class DrawContext {
  public:
    // Throws Error if OpenGL fails. If the choice is automatic and no GPU is found, uses the cpu
    // engine.
    explicit DrawContext(const Auto<ContextChoice>& choice);
    // Always makes an OpenGL context; throws Error if that fails.
    explicit DrawContext(gl::ContextKind kind);

    const Capabilities& capabilities() const { return capabilities_; }

    // Makes the OpenGL context current in the calling thread while the result lives; its destructor
    // makes the caller's context current again (gl/context.h). Returns null for the cpu engine.
    std::unique_ptr<gl::CurrentContext> make_current() const;

  private:
    std::unique_ptr<gl::Context> opengl_;  // null for the cpu engine
    Capabilities capabilities_;
};

}  // namespace lamina
