// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gl/context.h"
#include "lamina/auto.h"
#include "lamina/context_choice.h"

namespace lamina {

const char* name_of(ContextChoice choice);

// Tells whether it is the word of a context, or "auto".
bool is_context(const std::string& word);
// Lists these words for messages.
std::string context_words();
// Returns the choice of a word. Throws UsageError if the word is unknown.
Auto<ContextChoice> context_choice(const std::string& word);

// What draws a volume that stays in its files: the native engine alone. Throws Error where OpenGL
// is chosen.
ContextChoice context_for_files(const Auto<ContextChoice>& choice);

// The choice of a verb that needs OpenGL: throws UsageError for words that name no OpenGL context.
gl::ContextKind opengl_kind(const std::string& word);

// Restricts the native engine to the instruction set that the environment variable
// LAMINA_INSTRUCTIONS names, if it is set. This is for checks. Throws UsageError where the machine
// does not have these instructions.
void restrict_instructions_as_asked();

}  // namespace lamina
