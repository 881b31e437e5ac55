// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/export.h"

namespace lamina {

// The numbers that a picture is composited in. linear: linear light. display: what a screen is
// given, code / 255 of sRGB, taken as it is; so do VTK and ParaView.
enum class ImageColorSpace { linear, display };

LAMINA_API const char* name_of(ImageColorSpace space);

}  // namespace lamina
