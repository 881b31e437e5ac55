// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/field.h"
#include "lamina/image.h"
#include "lamina/scene.h"

namespace lamina {

// Warns (base/warning.h) where a picture of the scene shows nothing, and says why; where more than
// half of it is saturated; and where a colour map's range lies outside that of the data. The scene
// is one with nothing automatic, the field its data.
void warn_of_picture(const Scene& scene, const Field& field, const Image& picture);

}  // namespace lamina
