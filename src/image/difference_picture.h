// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/coded_image.h"
#include "image/difference.h"

namespace lamina {

// false_color() of a difference, pixel by pixel from the top left, and below it the colour bar from
// -scale to scale with its ends in figures. Where differences beyond it are shown as dark as these,
// the ends say so ("<=", ">="). White fills up what is narrower than the bar.
CodedImage difference_picture(const Difference& difference, double scale);

}  // namespace lamina
