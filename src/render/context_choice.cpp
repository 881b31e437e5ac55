// SPDX-License-Identifier: Apache-2.0
#include "render/context_choice.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/memory.h"
#include "simd/instruction_set.h"

namespace lamina {

const char* name_of(ContextChoice choice) {
    return word_of(choice, {"osmesa", "egl", "cpu"});
}

bool is_context(const std::string& word) {
    return word == "auto" || value_of_word<ContextChoice>(word);
}

std::string context_words() {
    return "auto, " + alternatives<ContextChoice>();
}

Auto<ContextChoice> context_choice(const std::string& word) {
    if (word == "auto") return automatic;
    if (const auto found = value_of_word<ContextChoice>(word)) return *found;
    throw UsageError(fmt::format("--context {}: expected {}", word, context_words()));
}

ContextChoice context_for_files(const Auto<ContextChoice>& choice) {
    if (choice.value_or(ContextChoice::cpu) != ContextChoice::cpu) {
        fail(
            "--context {}: the volume does not fit the memory limit of {} bytes, and OpenGL draws "
            "volumes in memory alone: expected cpu, or more memory (--memory)",
            name_of(choice), memory_limit());
    }
    return ContextChoice::cpu;
}

gl::ContextKind opengl_kind(const std::string& word) {
    const Auto<ContextChoice> choice = context_choice(word);
    if (choice.is_automatic()) return gl::ContextKind::any;
    switch (*choice) {
        case ContextChoice::osmesa:
            return gl::ContextKind::osmesa;
        case ContextChoice::egl:
            return gl::ContextKind::egl;
        case ContextChoice::cpu:
            throw UsageError(
                fmt::format("--context {}: this needs OpenGL, expected auto, osmesa or egl", word));
    }
    unreachable_enum();
}

void restrict_instructions_as_asked() {
    const char* const name = std::getenv("LAMINA_INSTRUCTIONS");
    if (name == nullptr || *name == '\0') return;
    try {
        restrict_instructions(name);
    } catch (const UsageError& error) {
        throw UsageError(fmt::format("LAMINA_INSTRUCTIONS: {}", error.what()));
    }
}

}  // namespace lamina
