// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// Which part of a picture one of several renderers draws: they draw it together.
struct PictureShare {
    int number = 0;  // 0 .. count - 1
    int count = 1;
};

}  // namespace lamina
