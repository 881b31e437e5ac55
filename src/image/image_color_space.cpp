// SPDX-License-Identifier: Apache-2.0
#include "lamina/image_color_space.h"

#include "base/enum_words.h"

namespace lamina {

const char* name_of(ImageColorSpace space) {
    return word_of(space, {"linear", "display"});
}

}  // namespace lamina
