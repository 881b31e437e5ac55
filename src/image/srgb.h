// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// The transfer curve of sRGB (IEC 61966-2-1), from linear light 0..1 to the stored value 0..1, and
// back. Callers must clamp arguments to 0..1.
double srgb_from_linear(double linear);
double linear_from_srgb(double stored);

}  // namespace lamina
