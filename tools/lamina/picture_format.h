// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

enum class PictureFormat { exr, png, npy };

// The name that means stdout, for -o, and stdin, for scenes.
inline constexpr const char* standard_stream = "-";

// How `output` (-o) is written: as its suffix says, or as `format` (--format) says where it is
// stdout. Throws UsageError where the two leave that open or contradict each other.
PictureFormat picture_format(const std::string& output, const std::string& format);

}  // namespace lamina
