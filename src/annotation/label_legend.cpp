// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "annotation/color_bar.h"

namespace lamina {
namespace {

// Sizes in ems; the largest block's height and width are shares of the picture's.
constexpr double row_height = 1.45, swatch_size = 0.95, swatch_gap = 0.5, tallest_legend = 0.8,
                 widest_legend = 1.0 / 3;

struct Entry {
    std::string text;
    glm::dvec3 color;
};

struct Legend {
    double em = 0;
    std::vector<std::string> caption = {};
    std::vector<Entry> entries = {};
    std::string rest = {};  // a line about labels without room; may be empty

    void draw(Pen& pen, const glm::dvec2& corner) const {
        const glm::dvec2 at(std::round(corner.x), std::round(corner.y));
        double y = 0;
        for (const std::string& line : caption) {
            pen.text_beside(line, at + glm::dvec2(0, y + row_height * em / 2), em);
            y += row_height * em;
        }
        const double side = std::round(swatch_size * em);
        for (const Entry& entry : entries) {
            const double middle = y + row_height * em / 2;
            const Rectangle swatch{at.x, at.y + std::round(middle - side / 2), side, side};
            const double t = pen.style.thickness(em);
            pen.canvas().fill(
                Rectangle{swatch.left - t, swatch.top - t, side + 2 * t, side + 2 * t},
                pen.style.line_paint(0.6));
            pen.canvas().fill(swatch, {entry.color});
            pen.text_beside(entry.text, at + glm::dvec2(side + swatch_gap * em, middle), em);
            y += row_height * em;
        }
        if (!rest.empty())
            pen.text_beside(rest, at + glm::dvec2(side + swatch_gap * em, y + row_height * em / 2),
                            em);
    }
};

}  // namespace

Block label_legend(Pen& pen, const Annotation& wanted, const Scene& scene,
                   const AnnotatedData& data, double height) {
    Legend legend{.em = pen.style.em * wanted.size};
    const double em = legend.em, indent = std::round(swatch_size * em) + swatch_gap * em;
    const double widest = widest_legend * pen.style.width;
    if (!wanted.text.empty()) {
        for (const std::string_view line : lines_of(wanted.text)) legend.caption.emplace_back(line);
    } else if (!data.quantity.name.empty()) {
        legend.caption = {pen.font.fitted(data.quantity.name, em, widest)};
    }
    std::vector<const Label*> shown;
    for (const Label& label : data.labels)
        if (scene.transfer_function->at(label.code).extinction > 0) shown.push_back(&label);
    const auto rows = static_cast<std::size_t>(std::max(
        2.0, std::floor(std::min(tallest_legend * pen.style.height, height) / (row_height * em)) -
                 double(legend.caption.size())));
    std::string note;
    if (shown.size() > rows) {
        const std::size_t left_out = shown.size() - (rows - 1);
        shown.resize(rows - 1);
        legend.rest = fmt::format("and {} more", left_out);
        note = fmt::format(
            "image.annotations.labels: the picture has room for {} of {} labels; a smaller "
            "\"size\" or a higher picture shows more",
            rows - 1, rows - 1 + left_out);
    }
    // Only texts that stay are fitted: a file may name many thousands.
    for (const Label* const label : shown) {
        const std::string& text = label->name.empty() ? label->number : label->name;
        legend.entries.push_back({pen.font.fitted(text, em, widest - indent),
                                  scene.transfer_function->at(label->code).color});
    }
    Block block{"image.annotations.labels",
                wanted.position.value_or(AnnotationPosition::right),
                {},
                true,
                {}};
    for (const std::string& line : legend.caption)
        block.size.x = std::max(block.size.x, pen.width(line, em));
    for (const Entry& entry : legend.entries)
        block.size.x = std::max(block.size.x, indent + pen.width(entry.text, em));
    block.size.x = std::max(block.size.x, indent + pen.width(legend.rest, em));
    const std::size_t lines =
        legend.caption.size() + legend.entries.size() + (legend.rest.empty() ? 0 : 1);
    block.size = {std::ceil(block.size.x), std::ceil(row_height * em * double(lines))};
    block.note = note;
    block.draw = [legend](Pen& drawing, const glm::dvec2& at) { legend.draw(drawing, at); };
    return block;
}

}  // namespace lamina
