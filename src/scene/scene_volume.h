// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"

namespace lamina {

// The volume that a scene names, as load_volume() loads it; it stays in its files where it does not
// fit the memory limit (volume_files/volume_opening.h). Throws Error.
Volume open_volume(const Scene& scene);

}  // namespace lamina
