// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume_files/dicom_image.h"

namespace lamina {

// Writes image.byte_count() bytes of the pixels of a compressed image to `to`. Throws Error, also
// where the build has no decoder.
void decode_dicom(const DicomImage& image, char* to);

}  // namespace lamina
