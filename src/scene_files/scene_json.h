// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "lamina/scene.h"

namespace lamina {

// A scene file (docs/scene.md) with every key written out, from which read_scene() makes the same
// scene: paths are absolute, numbers have all their digits, the transfer function is its points,
// whatever they were made from, but for a colour map that is to be stretched over the data.
// save_scene() writes it.
nlohmann::ordered_json scene_json(const Scene& scene);

// The two keys of these names.
nlohmann::ordered_json transfer_function_json(const TransferFunction& transfer_function);
nlohmann::ordered_json camera_json(const Camera& camera);

}  // namespace lamina
