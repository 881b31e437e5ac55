// SPDX-License-Identifier: Apache-2.0
#include "annotation/font.h"

// The bytes of share/fonts/DejaVuSans.ttf.
asm(R"(
    .pushsection .rodata
    .balign 16
lamina_font_begin:
    .incbin ")" LAMINA_FONT_FILE R"("
lamina_font_end:
    .popsection
)");

extern "C" {
extern const unsigned char lamina_font_begin[], lamina_font_end[];
}

namespace lamina {

std::span<const unsigned char> font_file() {
    return {lamina_font_begin, static_cast<std::size_t>(lamina_font_end - lamina_font_begin)};
}

}  // namespace lamina
