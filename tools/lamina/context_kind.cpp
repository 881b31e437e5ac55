// SPDX-License-Identifier: Apache-2.0
#include "context_kind.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lamina {

gl::ContextKind context_kind(const std::string& word) {
    if (word == "auto") return gl::ContextKind::automatic;
    if (word == "osmesa") return gl::ContextKind::osmesa;
    if (word == "egl") return gl::ContextKind::egl;
    throw UsageError(fmt::format("--context {}: expected auto, osmesa or egl", word));
}

}  // namespace lamina
