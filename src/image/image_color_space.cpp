// SPDX-License-Identifier: Apache-2.0
#include "lamina/image_color_space.h"

namespace lamina {

const char* name_of(ImageColorSpace space) {
    switch (space) {
        case ImageColorSpace::linear:
            return "linear";
        case ImageColorSpace::display:
            return "display";
    }
    return nullptr;
}

}  // namespace lamina
