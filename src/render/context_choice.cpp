// SPDX-License-Identifier: Apache-2.0
#include "render/context_choice.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/memory_limit.h"
#include "base/unreachable.h"
#include "tiles/instruction_set.h"

namespace lamina {

// Its words are listed by enum_words() (base/enum_words.h), too.
const char* name_of(ContextChoice choice) {
    switch (choice) {
        case ContextChoice::automatic:
            return "auto";
        case ContextChoice::osmesa:
            return "osmesa";
        case ContextChoice::egl:
            return "egl";
        case ContextChoice::cpu:
            return "cpu";
    }
    return nullptr;
}

ContextChoice context_choice(const std::string& word) {
    if (const auto found = value_of_word<ContextChoice>(word)) return *found;
    throw UsageError(fmt::format("--context {}: expected {}", word, alternatives<ContextChoice>()));
}

ContextChoice context_for_files(ContextChoice choice) {
    if (choice != ContextChoice::automatic && choice != ContextChoice::cpu) {
        fail(
            "--context {}: the volume does not fit the memory limit of {} bytes, and OpenGL draws "
            "volumes in memory alone: expected cpu, or more memory (--memory)",
            name_of(choice), memory_limit());
    }
    return ContextChoice::cpu;
}

gl::ContextKind opengl_kind(const std::string& word) {
    switch (context_choice(word)) {
        case ContextChoice::automatic:
            return gl::ContextKind::automatic;
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
