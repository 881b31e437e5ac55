// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "base/input_file.h"

namespace lamina {

// The files of share/colormaps, "viridis.json" and others.
std::span<const EmbeddedFile> embedded_colormaps();

}  // namespace lamina
