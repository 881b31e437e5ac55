// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gl/context.h"
#include "lamina/auto.h"
#include "lamina/context_choice.h"

namespace lamina {

const char* name_of(ContextChoice choice);

// Tells whether `word` names a context or is "auto".
bool is_context(const std::string& word);
// Lists these words for messages.
std::string context_words();
// Returns the choice of a word. Throws UsageError if the word is unknown.
Auto<ContextChoice> context_choice(const std::string& word);

// Returns the context for a volume that stays in its files: the engine `cpu` alone. Throws Error if
// OpenGL is chosen.
ContextChoice context_for_files(const Auto<ContextChoice>& choice);

// Returns the choice of a verb that needs OpenGL. Throws UsageError for words that name no OpenGL
// context.
gl::ContextKind opengl_kind(const std::string& word);

// Restricts the engine `cpu` to the instruction set that the environment variable
// LAMINA_INSTRUCTIONS names, if it is set. This is for checks. Throws UsageError if the machine
// does not have these instructions.
void restrict_instructions_as_asked();

}  // namespace lamina
