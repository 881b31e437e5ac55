// SPDX-License-Identifier: Apache-2.0
#include "render/context_choice.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/error.h"
#include "base/unreachable.h"
#include "tiles/instruction_set.h"

namespace lamina {

std::optional<ContextChoice> find_context_choice(const std::string& word) {
    if (word == "auto") return ContextChoice::automatic;
    if (word == "osmesa") return ContextChoice::osmesa;
    if (word == "egl") return ContextChoice::egl;
    if (word == "cpu") return ContextChoice::cpu;
    return std::nullopt;
}

ContextChoice context_choice(const std::string& word) {
    if (const auto found = find_context_choice(word)) return *found;
    throw UsageError(fmt::format("--context {}: expected auto, osmesa, egl or cpu", word));
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
