// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// The transfer curve of sRGB (IEC 61966-2-1): linear light 0..1 to the stored value 0..1, and back.
// Odd about 0 is not attempted: arguments outside 0..1 are the caller's to clamp.
double srgb_from_linear(double linear);
double linear_from_srgb(double stored);

}  // namespace lamina
