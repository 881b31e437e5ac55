// SPDX-License-Identifier: Apache-2.0
#include "render/draw_context.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/enum_words.h"
#include "base/error.h"
#include "simd/instruction_set.h"
#include "tiles/cpu_capabilities.h"

namespace lamina {
namespace {

// Returns null if there is no GPU with OpenGL 4.5.
std::unique_ptr<gl::Context> find_gpu() {
    try {
        return gl::Context::create(gl::ContextKind::gpu);
    } catch (const Error&) {
        return nullptr;
    }
}

std::unique_ptr<gl::Context> make_opengl(const Auto<ContextChoice>& choice) {
    if (choice.is_automatic()) return find_gpu();
    switch (*choice) {
        case ContextChoice::osmesa:
            return gl::Context::create(gl::ContextKind::osmesa);
        case ContextChoice::egl:
            return gl::Context::create(gl::ContextKind::egl);
        case ContextChoice::cpu:
            return nullptr;
    }
    unreachable_enum();
}

}  // namespace

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

void restrict_instructions_as_asked() {
    const char* const name = std::getenv("LAMINA_INSTRUCTIONS");
    if (name == nullptr || *name == '\0') return;
    try {
        restrict_instructions(name);
    } catch (const UsageError& error) {
        throw UsageError(fmt::format("LAMINA_INSTRUCTIONS: {}", error.what()));
    }
}

DrawContext::DrawContext(const Auto<ContextChoice>& choice)
    : opengl_(make_opengl(choice)),
      capabilities_(opengl_ ? opengl_->capabilities() : cpu_capabilities()) {}

DrawContext::DrawContext(gl::ContextKind kind)
    : opengl_(gl::Context::create(kind)), capabilities_(opengl_->capabilities()) {}

std::unique_ptr<gl::CurrentContext> DrawContext::make_current() const {
    return opengl_ ? std::make_unique<gl::CurrentContext>(*opengl_) : nullptr;
}

}  // namespace lamina
