// SPDX-License-Identifier: Apache-2.0
#include "annotation/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numeric>

#include "base/enum_words.h"
#include "image/coded_image.h"

namespace lamina {
namespace {

// Share of the picture's height that the em of normal text takes, and its least size in pixels: at
// less, figures cannot be read.
constexpr double em_share = 1.0 / 38, least_em = 9;
// Display values of ink on light and on dark paper.
constexpr double dark = 0.1, light = 0.95;
// Relative luminance (Rec. 709, linear light) from which on paper counts as light: then dark ink
// has the greater contrast, (Y + .05) / .05 > 1.05 / (Y + .05), by WCAG 2.
constexpr double light_luminance = 0.179;
constexpr double line_distance = 1.35;  // of base lines, in ems
constexpr double ascent = 0.95;         // from a line's top to its base line, in ems

enum class Side { low, middle, high };

Side across(AnnotationPosition position) {
    switch (position) {
        case AnnotationPosition::top_left:
        case AnnotationPosition::left:
        case AnnotationPosition::bottom_left:
            return Side::low;
        case AnnotationPosition::top:
        case AnnotationPosition::bottom:
            return Side::middle;
        case AnnotationPosition::top_right:
        case AnnotationPosition::right:
        case AnnotationPosition::bottom_right:
            return Side::high;
    }
    return Side::low;
}

Side down(AnnotationPosition position) {
    switch (position) {
        case AnnotationPosition::top_left:
        case AnnotationPosition::top:
        case AnnotationPosition::top_right:
            return Side::low;
        case AnnotationPosition::left:
        case AnnotationPosition::right:
            return Side::middle;
        case AnnotationPosition::bottom_left:
        case AnnotationPosition::bottom:
        case AnnotationPosition::bottom_right:
            return Side::high;
    }
    return Side::low;
}

double start_of(Side side, double size, double whole, double gap) {
    if (side == Side::middle) return std::round((whole - size) / 2);
    return side == Side::low ? gap : whole - gap - size;
}

}  // namespace

const char* name_of(AnnotationPosition position) {
    return word_of(position, {"top_left", "top", "top_right", "left", "right", "bottom_left",
                              "bottom", "bottom_right"});
}

AnnotationStyle::AnnotationStyle(const Scene& scene)
    : width(scene.width), height(scene.height), space(scene.color_space), paper(scene.background) {
    glm::dvec3 shown = glm::clamp(paper, 0.0, 1.0);
    if (space == ImageColorSpace::display) {
        for (int c = 0; c < 3; ++c) shown[c] = linear_from_srgb(shown[c]);
    }
    dark_ink = 0.2126 * shown.r + 0.7152 * shown.g + 0.0722 * shown.b > light_luminance;
    ink = shade(glm::dvec3(dark_ink ? dark : light));
    em = std::max(least_em, em_share * height);
    gap = 0.8 * em;
}

glm::dvec3 AnnotationStyle::shade(const glm::dvec3& display) const {
    if (space == ImageColorSpace::display) return display;
    return {linear_from_srgb(display.r), linear_from_srgb(display.g), linear_from_srgb(display.b)};
}

Paint AnnotationStyle::text_paint(double opacity) const {
    return {ink, opacity, dark_ink ? Paint::Edges::of_dark_text : Paint::Edges::of_light_text};
}

void Pen::text(std::string_view line, const glm::dvec2& anchor, double size, Align align) {
    const double moved = align == Align::left ? 0 : width(line, size);
    const double left = anchor.x - (align == Align::center ? moved / 2 : moved);
    const glm::dvec2 start(left, std::round(anchor.y));
    canvas_->fill(font.outlines(line, start, size), style.text_paint());
}

void Pen::text_beside(std::string_view line, const glm::dvec2& anchor, double size, Align align) {
    text(line, {anchor.x, anchor.y + Font::capital_height(size) / 2}, size, align);
}

std::vector<Rectangle> placed(const std::vector<Block>& blocks, const AnnotationStyle& style) {
    std::vector<Rectangle> places(blocks.size());
    for (std::size_t first = 0; first < blocks.size(); ++first) {
        const AnnotationPosition position = blocks[first].position;
        std::vector<std::size_t> group;
        for (std::size_t i = 0; i < blocks.size(); ++i)
            if (blocks[i].position == position) group.push_back(i);
        if (group.front() != first) continue;  // placed already
        double whole = -style.gap;
        for (const std::size_t i : group) whole += blocks[i].size.y + style.gap;
        double top = start_of(down(position), whole, style.height, style.gap);
        for (const std::size_t i : group) {
            const glm::dvec2& size = blocks[i].size;
            places[i] = {start_of(across(position), size.x, style.width, style.gap), top, size.x,
                         size.y};
            top += size.y + style.gap;
        }
    }
    return places;
}

bool overlap(const Rectangle& a, const Rectangle& b) {
    return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

namespace {

// Tells whether a block for which the camera leaves no room keeps to its quarter of the picture:
// the data lie in the middle.
bool leaves_the_middle(const Block& block, const AnnotationStyle& style) {
    const glm::dvec2 reach = block.size + style.gap;
    return block.makes_room || (2 * reach.x <= style.width && 2 * reach.y <= style.height);
}

bool all_fit(std::vector<Block> blocks, const AnnotationStyle& style) {
    for (Block& block : blocks) block.size = glm::max(block.size, block.largest);
    const std::vector<Rectangle> places = placed(blocks, style);
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (!style.holds(places[i]) || !leaves_the_middle(blocks[i], style)) return false;
        for (std::size_t j = 0; j < i; ++j)
            if (overlap(places[i], places[j])) return false;
    }
    return true;
}

}  // namespace

std::vector<std::string> take_misfits(std::vector<Block>& blocks, const AnnotationStyle& style) {
    std::vector<std::size_t> order(blocks.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return blocks[i].rank; });
    std::vector<bool> kept(blocks.size());
    const auto chosen = [&] {
        std::vector<Block> some;
        for (std::size_t i = 0; i < blocks.size(); ++i)
            if (kept[i]) some.push_back(blocks[i]);
        return some;
    };
    std::vector<std::string> misfits;
    for (const std::size_t i : order) {
        kept[i] = true;
        if (all_fit(chosen(), style)) continue;
        kept[i] = false;
        misfits.push_back(blocks[i].key);
    }
    blocks = chosen();
    return misfits;
}

double free_height(const std::vector<Block>& blocks, AnnotationPosition side,
                   const AnnotationStyle& style) {
    double taken = 0;
    for (const Side end : {Side::low, Side::high}) {
        double here = style.gap;
        for (const Block& block : blocks) {
            const Side x = across(block.position);
            if (down(block.position) == end && (x == across(side) || x == Side::middle))
                here += block.size.y + style.gap;
        }
        taken = std::max(taken, here);
    }
    return style.height - 2 * taken;  // the block stands in the middle
}

PictureMargins margins_of(const std::vector<Block>& blocks, const AnnotationStyle& style) {
    PictureMargins margins;
    const std::vector<Rectangle> places = placed(blocks, style);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (!blocks[i].makes_room) continue;
        const Rectangle& place = places[i];
        const Side x = across(blocks[i].position), y = down(blocks[i].position);
        // Blocks beside the picture's middle take a margin at the side, all others one above or
        // below.
        if (y == Side::middle && x == Side::low)
            margins.left = std::max(margins.left, place.right() + style.gap / 2);
        else if (y == Side::middle)
            margins.right = std::max(margins.right, style.width - place.left + style.gap / 2);
        else if (y == Side::low)
            margins.top = std::max(margins.top, place.bottom());
        else
            margins.bottom = std::max(margins.bottom, style.height - place.top);
    }
    return margins;
}

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t end = 0; end != text.npos;
         text.remove_prefix(end == text.npos ? 0 : end + 1)) {
        end = text.find('\n');
        std::string_view line = text.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        lines.push_back(line);
    }
    return lines;
}

Block text_block(Pen& pen, const Annotation& annotation, double size, const std::string& key,
                 AnnotationPosition position) {
    Block block{key, annotation.position.value_or(position), {}, true, {}};
    std::vector<std::string> lines;
    for (const std::string_view line : lines_of(annotation.text)) lines.emplace_back(line);
    const auto widest = [&](double of_size) {
        double width = 0;
        for (const std::string& line : lines) width = std::max(width, pen.width(line, of_size));
        return width;
    };
    const double room = pen.style.width - 2 * pen.style.gap, wanted = widest(size);
    if (wanted > room) {
        // One in 1000 less, so that rounding does not make the widest line too wide.
        size = std::min(size, std::max(least_em, 0.999 * size * room / wanted));
        const bool cut = widest(size) > room;
        if (cut)
            for (std::string& line : lines) line = pen.font.fitted(line, size, room);
        block.note = fmt::format(
            "{}: is too long for a picture {} pixels wide, and is {}; a text may have several "
            "lines",
            key, pen.style.width, cut ? "cut" : "written smaller");
    }
    block.size.x = widest(size);
    block.size.y = size * (line_distance * static_cast<double>(lines.size() - 1) + 1.2);
    block.draw = [lines, size, width = block.size.x, side = across(block.position)](
                     Pen& drawing, const glm::dvec2& at) {
        const Align align = side == Side::low      ? Align::left
                            : side == Side::middle ? Align::center
                                                   : Align::right;
        const double x = align == Align::left ? 0 : align == Align::center ? width / 2 : width;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            drawing.text(lines[i], at + glm::dvec2(x, size * (ascent + line_distance * double(i))),
                         size, align);
        }
    };
    return block;
}

}  // namespace lamina
