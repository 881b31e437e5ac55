// SPDX-License-Identifier: Apache-2.0
// The two ways to make a context. Each throws Error with the reason where it fails.
#pragma once

#include <memory>

#include "gl/context.h"

namespace lamina::gl {

enum class EglDevices { hardware, any };

std::unique_ptr<Context> create_osmesa_context();
std::unique_ptr<Context> create_egl_context(EglDevices devices);

}  // namespace lamina::gl
