// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// The part of a volume that one of several renderers draws, which draw one picture together.
struct PictureShare {
    int number = 0;  // 0 .. count - 1
    int count = 1;
};

}  // namespace lamina
