// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

enum class PictureFormat { exr, png, npy };

// How `output` (-o) is written: as its suffix says, or as `format` (--format) says where it is
// stdout. Throws UsageError where the two leave that open or contradict each other.
PictureFormat picture_format(const std::string& output, const std::string& format);

}  // namespace lamina
