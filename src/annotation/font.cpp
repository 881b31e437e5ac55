// SPDX-License-Identifier: Apache-2.0
#include "annotation/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <algorithm>

#include "base/error.h"

namespace lamina {
namespace {

constexpr char32_t replacement = 0xFFFD;

// Reads the character at the front of a text, and removes it. Returns nothing, and removes one
// byte, if none begins there.
std::optional<char32_t> next_character(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    char32_t character = length == 1 ? first : first & (0x7Fu >> length);
    bool good = length > 0 && length <= text.size();
    for (std::size_t i = 1; good && i < length; ++i) {
        good = (byte(i) & 0xC0) == 0x80;
        character = character << 6 | (byte(i) & 0x3Fu);
    }
    constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    good = good && character >= least[length] && character <= 0x10FFFF &&
           !(character >= 0xD800 && character < 0xE000);
    text.remove_prefix(good ? length : 1);
    return good ? std::optional(character) : std::nullopt;
}

std::vector<char32_t> drawn_characters(std::string_view text) {
    std::vector<char32_t> characters;
    while (!text.empty()) characters.push_back(next_character(text).value_or(replacement));
    return characters;
}

glm::dvec2 point_of(const FT_Vector* at) {
    return {static_cast<double>(at->x), static_cast<double>(at->y)};
}

}  // namespace

struct Font::Library {
    Library() {
        const auto bytes = font_file();
        if (FT_Init_FreeType(&library) != 0 ||
            FT_New_Memory_Face(library, bytes.data(), static_cast<FT_Long>(bytes.size()), 0,
                               &face) != 0)
            fail("annotations: FreeType cannot read the font DejaVu Sans");
    }
    ~Library() {
        FT_Done_Face(face);
        FT_Done_FreeType(library);
    }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    double units() const { return face->units_per_EM; }

    FT_Library library = nullptr;
    FT_Face face = nullptr;
};

std::optional<std::vector<char32_t>> characters_of(std::string_view text) {
    std::vector<char32_t> characters;
    while (!text.empty()) {
        const auto character = next_character(text);
        if (!character) return std::nullopt;
        characters.push_back(*character);
    }
    return characters;
}

void check_text(const std::string& key, std::string_view text) {
    if (text.size() > longest_text) {
        fail("{}: found a text of {} bytes, expected at most {}", key, text.size(), longest_text);
    }
    if (characters_of(text)) return;
    std::string_view rest = text;
    std::size_t place = 0;
    while (next_character(rest)) place = text.size() - rest.size();
    fail("{}: byte {} of the text is 0x{:02x}, expected UTF-8", key, place,
         static_cast<unsigned char>(text[place]));
}

Font::Font() : library_(std::make_unique<Library>()) {}
Font::~Font() = default;

const Font::Glyph& Font::glyph(char32_t character) {
    const auto known = glyphs_.find(character);
    if (known != glyphs_.end()) return known->second;
    Glyph made;
    const FT_Face face = library_->face;
    const FT_UInt index = FT_Get_Char_Index(face, character);
    if (index == 0) missing_.push_back(character);
    if (FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0)
        fail("annotations: FreeType cannot read the outline of U+{:04X}", std::uint32_t(character));
    made.advance = static_cast<double>(face->glyph->advance.x);
    FT_Outline_Funcs take{};
    take.move_to = [](const FT_Vector* to, void* into) {
        static_cast<Glyph*>(into)->outline.push_back({Command::Kind::move, {}, point_of(to)});
        return 0;
    };
    take.line_to = [](const FT_Vector* to, void* into) {
        static_cast<Glyph*>(into)->outline.push_back({Command::Kind::line, {}, point_of(to)});
        return 0;
    };
    take.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* into) {
        static_cast<Glyph*>(into)->outline.push_back(
            {Command::Kind::curve, point_of(control), point_of(to)});
        return 0;
    };
    // TrueType has no cubic curves.
    take.cubic_to = [](const FT_Vector*, const FT_Vector*, const FT_Vector*, void*) { return 1; };
    FT_Outline_Decompose(&face->glyph->outline, &take, &made);
    return glyphs_.emplace(character, std::move(made)).first->second;
}

double Font::width(std::string_view text, double size) {
    double units = 0;
    for (const char32_t character : drawn_characters(text)) units += glyph(character).advance;
    return units * size / library_->units();
}

std::string Font::fitted(std::string_view text, double size, double most) {
    constexpr std::string_view ellipsis = "\u2026";
    const double units_of_ellipsis = glyph(U'\u2026').advance;
    const auto fits = [&](double units) { return units * size / library_->units() <= most; };
    double units = 0;
    std::size_t kept = 0;  // bytes that leave room for an ellipsis
    for (std::string_view rest = text; !rest.empty();) {
        units += glyph(next_character(rest).value_or(replacement)).advance;
        const std::size_t passed = text.size() - rest.size();
        if (passed > longest_text || !fits(units))
            return std::string(text.substr(0, kept)).append(ellipsis);
        if (fits(units + units_of_ellipsis)) kept = passed;
    }
    return std::string(text);
}

Outline Font::outlines(std::string_view text, const glm::dvec2& start, double size) {
    Outline path;
    const double scale = size / library_->units();
    glm::dvec2 pen = start;
    for (const char32_t character : drawn_characters(text)) {
        const Glyph& drawn = glyph(character);
        const auto place = [&](const glm::dvec2& point) {
            return pen + glm::dvec2(scale * point.x, -scale * point.y);
        };
        for (const Command& command : drawn.outline) {
            switch (command.kind) {
                case Command::Kind::move:
                    path.move_to(place(command.end));
                    break;
                case Command::Kind::line:
                    path.line_to(place(command.end));
                    break;
                case Command::Kind::curve:
                    path.curve_to(place(command.control), place(command.end));
                    break;
            }
        }
        pen.x += drawn.advance * scale;
    }
    return path;
}

}  // namespace lamina
