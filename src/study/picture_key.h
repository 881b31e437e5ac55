// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "lamina/volume.h"
#include "optics/colormap.h"
#include "scene/scene_mesh.h"

namespace lamina::study {

// All that an exact picture depends on beside its data: transfer function, camera, size,
// clip and lighting.
std::string picture_key(const Scene& scene);

std::string transfer_function_key(const TransferFunction& transfer_function);

// Identifies the contents of data, wherever they came from.
std::string content_of(const Volume& volume);
std::string content_of(const SceneMesh& mesh);
std::string content_of(const Colormap& colormap);

}  // namespace lamina::study
