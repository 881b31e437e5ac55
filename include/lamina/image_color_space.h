// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/export.h"

namespace lamina {

// Numbers in which a picture is composited. linear: linear light. display: the values that a screen
// gets, code / 255 of sRGB, as VTK and ParaView composite them.
enum class ImageColorSpace { linear, display };

LAMINA_API const char* name_of(ImageColorSpace space);

}  // namespace lamina
