// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"

namespace lamina::papers {

// Two answers to a question of LaMar 2004, section 5: how to give every slice its own dithered
// palette. Full-screen slices of an 8-bit texture are blended in 8 bits. The palette of 256 entries
// changes with period `period`.
class PaletteSlices {
  public:
    enum class Way {
        upload,  // the palette is uploaded before each slice
        lookup,  // all palettes are in one texture, with one dependent lookup
    };
    PaletteSlices(Way way, int pixels, int slices, int period);

    Image draw();  // draws a frame, which is complete on return

  private:
    Way way_;
    int slices_, period_;
    std::vector<std::uint8_t> palettes_;  // 256 RGBA entries each
    gl::Texture indices_, palette_;
    gl::Framebuffer target_;
    gl::Program program_;
    gl::VertexArray no_attributes_;
};

}  // namespace lamina::papers
