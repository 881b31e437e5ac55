// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/value_type.h"
#include "lamina/volume.h"
#include "lamina/volume_request.h"
#include "volume_files/volume_opening.h"

namespace lamina {

// Returns the type that NumPy writes as "f8" and the like, behind the byte order; a truth value is
// a byte.
std::optional<ValueType> numpy_type(std::string_view word);

// Tells NumPy's format by its magic string.
bool is_npy(const std::filesystem::path& path);

// Reads NumPy's format (NEP 1): an array [z, y, x] of any real type, byte order and memory order.
// Samples lie 1 apart from 0 on, as nodes. Throws Error.
Volume open_npy(const std::filesystem::path& path, const VolumeRequest& request = {},
                const VolumeUse& use = {});

}  // namespace lamina
