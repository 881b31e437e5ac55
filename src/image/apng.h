// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "base/output_file.h"

namespace lamina {

// Writes an animated PNG (APNG; PNG, third edition) that plays again and again, from PNG files of
// one size and kind. Programs that do not know APNG show its first frame. The caller commits the
// file.
class AnimatedPng {
  public:
    // `rate`: frames a second, 1 to 65535.
    AnimatedPng(OutputFile& file, std::uint32_t frames, int rate);

    // Adds a frame: the bytes of a PNG file. Throws Error if it is not one or another frame's size
    // or kind differ.
    void add(const std::string& png);
    void end();  // after the last frame

  private:
    void write_chunk(const std::string& type, const std::string& content);
    std::string next_number();

    OutputFile& file_;
    std::uint32_t frames_;
    int rate_;
    std::string header_;        // content of IHDR, which all frames share; empty: no frame yet
    std::uint32_t number_ = 0;  // of the next fcTL or fdAT chunk
};

}  // namespace lamina
