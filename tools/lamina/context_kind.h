// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gl/context.h"

namespace lamina {

// The word of --context; throws UsageError where it is none.
gl::ContextKind context_kind(const std::string& word);

}  // namespace lamina
