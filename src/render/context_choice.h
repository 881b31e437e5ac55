// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gl/context.h"

namespace lamina {

// --context. automatic: a GPU through EGL where there is one, else the native engine.
enum class ContextChoice { automatic, osmesa, egl, cpu };

const char* name_of(ContextChoice choice);

// Throws UsageError where the word is none.
ContextChoice context_choice(const std::string& word);

// Of a verb that needs OpenGL.
gl::ContextKind opengl_kind(const std::string& word);

// The native engine's instructions, where the environment has LAMINA_INSTRUCTIONS, for checks;
// throws UsageError where the machine does not have them.
void restrict_instructions_as_asked();

}  // namespace lamina
