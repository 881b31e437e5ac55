// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// A rectangle of pixels; row 0 is the top.
struct PictureTile {
    int column = 0, row = 0;  // upper left pixel
    int width = 0, height = 0;
};

}  // namespace lamina
