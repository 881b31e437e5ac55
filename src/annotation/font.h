// SPDX-License-Identifier: Apache-2.0
#pragma once

// Text as outlines of DejaVu Sans (share/fonts), which is part of the program. FreeType reads the
// outlines in the font's own units; what is filled does not depend on its version or settings.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "annotation/canvas.h"

namespace lamina {

// Returns the characters of a text in UTF-8; nothing if it is none: bytes that begin no character,
// longer forms than needed, surrogates, characters beyond U+10FFFF.
std::optional<std::vector<char32_t>> characters_of(std::string_view text);

// Largest size of a text in bytes: more than a picture can show. A character's outline takes about
// a kilobyte of memory.
constexpr std::size_t longest_text = 10'000;

// Throws Error, which names `key`, unless the text is UTF-8 and at most `longest_text` long.
void check_text(const std::string& key, std::string_view text);

std::span<const unsigned char> font_file();

class Font {
  public:
    Font();
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    // Return the width of a line of text, and the height of its capitals and digits, in pixels.
    // `size`: of the em, in pixels.
    double width(std::string_view text, double size);
    static double capital_height(double size) { return 0.729 * size; }  // of DejaVu Sans

    // Shortens a text with an ellipsis until it is at most `most` pixels wide, and about
    // `longest_text` long: characters may have no width. Texts from files have any length, so it
    // reads no farther than needed.
    std::string fitted(std::string_view text, double size, double most);

    // Returns the outlines of a line of text that begins at `start`, on its base line. Bytes that
    // are no UTF-8 become U+FFFD.
    Outline outlines(std::string_view text, const glm::dvec2& start, double size);

    // Returns the characters that the font lacked so far; a box stands for each.
    const std::vector<char32_t>& missing() const { return missing_; }

  private:
    // A curve of an outline, in the font's units, y up.
    struct Command {
        enum class Kind { move, line, curve } kind;
        glm::dvec2 control, end;
    };
    struct Glyph {
        std::vector<Command> outline;
        double advance = 0;
    };
    struct Library;

    const Glyph& glyph(char32_t character);

    std::unique_ptr<Library> library_;
    std::map<char32_t, Glyph> glyphs_;
    std::vector<char32_t> missing_;
};

}  // namespace lamina
