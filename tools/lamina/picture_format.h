// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

enum class PictureFormat { exr, png, npy };

// Returns the format of `output` (-o): that of its suffix, or `format` (--format) for stdout.
// Throws UsageError if the two leave it open or contradict each other.
PictureFormat picture_format(const std::string& output, const std::string& format);

}  // namespace lamina
