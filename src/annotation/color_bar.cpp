// SPDX-License-Identifier: Apache-2.0
#include "annotation/color_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "annotation/numbers.h"
#include "scene/given_transfer.h"

namespace lamina {
namespace {

// Sizes in ems, but for the bar's height, which is a share of the picture's.
constexpr double bar_share = 0.5, bar_width = 0.9, curve_width = 2.4, tick_length = 0.3,
                 tick_gap = 0.25, least_tick_distance = 1.9, text_line = 1.35, caption_gap = 0.45,
                 small_text = 0.8;
constexpr int most_ticks = 11;
// Largest opacity of a curve whose length is chosen; the round length below makes it .6 or more.
constexpr double chosen_opacity = 0.9;

// The length that opacities refer to, in world units.
double length_of_opacity(const Scene& scene, double largest_extinction) {
    const GivenTransfer* const given = scene.given_transfer.get();
    const bool by_opacity =
        given != nullptr && std::ranges::any_of(given->points, [](const GivenPoint& point) {
            return point.given_as == GivenPoint::Density::opacity;
        });
    if (by_opacity) return given->unit_length;
    return round_number_up_to(-std::log1p(-chosen_opacity) / largest_extinction);
}

std::string length_text(double length, const std::string& unit) {
    const std::string number = number_text(length);
    if (!unit.empty()) return number + " " + unit;
    return number + (length == 1 ? " unit" : " units");
}

std::vector<std::string> caption_of(Pen& pen, const Annotation& wanted, const Quantity& quantity,
                                    double em) {
    std::vector<std::string> lines;
    if (!wanted.text.empty()) {
        for (const std::string_view part : lines_of(wanted.text)) lines.emplace_back(part);
        return lines;
    }
    const auto& [name, unit] = quantity;
    const std::string unit_text = unit.empty() || name.empty() ? unit : "(" + unit + ")";
    const std::string all = name + (name.empty() || unit.empty() ? "" : " ") + unit_text;
    if (all.empty()) return lines;
    const std::string fitted = pen.fitted_name(all, em);
    if (fitted == all || name.empty() || unit.empty()) return {fitted};
    return {pen.fitted_name(name, em), pen.fitted_name(unit_text, em)};
}

// A colour bar that is laid out. Lengths are in pixels, from the block's upper left corner.
struct Bar {
    TransferFunction function;
    BarRange range;
    double em = 0;
    std::vector<std::string> caption = {}, numbers = {};
    std::vector<double> values = {};  // of the numbers
    std::string opacity_text = {};    // empty: without a curve
    double length = 0;                // that opacities refer to, in world units
    double top = 0;                   // of the bar
    int left = 0, width = 0, rows = 0;

    double row_of(double value) const {
        const double share = range.hi > range.lo ? (range.hi - value) / (range.hi - range.lo) : 0.5;
        return top + share * rows;
    }
    double opacity(double lo, double hi) const {
        return opacity_from_depth(length * function.max_extinction(lo, hi));
    }

    void draw(Pen& pen, const glm::dvec2& at) const;
    void draw_colors(Pen& pen, const glm::dvec2& at) const;
    void draw_curve(Pen& pen, const glm::dvec2& at) const;
    void draw_numbers(Pen& pen, const glm::dvec2& at) const;
};

void Bar::draw(Pen& pen, const glm::dvec2& corner) const {
    const glm::dvec2 at(std::round(corner.x), std::round(corner.y));
    for (std::size_t i = 0; i < caption.size(); ++i)
        pen.text(caption[i], at + glm::dvec2(0, em * (0.95 + text_line * double(i))), em);
    if (!opacity_text.empty()) draw_curve(pen, at);
    draw_colors(pen, at);
    draw_numbers(pen, at);
}

void Bar::draw_colors(Pen& pen, const glm::dvec2& at) const {
    for (int row = 0; row < rows; ++row) {
        const Rectangle pixels{at.x + left, at.y + top + row, double(width), 1};
        pen.canvas().fill(pixels, {function.at(value_at(range, row, rows)).color});
    }
    const double t = pen.style.thickness(em);
    const Rectangle r{at.x + left, at.y + top, double(width), double(rows)};
    const Paint paint = pen.style.line_paint(0.6);
    Canvas& canvas = pen.canvas();
    canvas.fill(Rectangle{r.left - t, r.top - t, r.width + 2 * t, t}, paint);
    canvas.fill(Rectangle{r.left - t, r.bottom(), r.width + 2 * t, t}, paint);
    canvas.fill(Rectangle{r.left - t, r.top, t, r.height}, paint);
    canvas.fill(Rectangle{r.right(), r.top, t, r.height}, paint);
}

// Draws the opacity to the left of the bar: 0 at the bar, 1 at the block's left end.
void Bar::draw_curve(Pen& pen, const glm::dvec2& at) const {
    const double t = pen.style.thickness(em), base = left - 2 * t, wide = base - t;
    // Whole 64ths of a pixel do not depend on the last bits of expm1().
    const auto place = [&](double share, double y) {
        return at + glm::dvec2(base - std::round(64 * wide * share) / 64, y);
    };
    const auto value = [&](double row) {
        return range.hi - (range.hi - range.lo) * std::min(row / rows, 1.0);
    };
    std::vector<glm::dvec2> curve;
    for (int row = 0; row <= rows; ++row) {
        const double here = value(row), next = value(row + 1);
        const double now = opacity(here, here);
        curve.push_back(place(now, top + row));
        if (row == rows) break;
        // A peak between two rows shows, too.
        const double most = opacity(next, here), then = opacity(next, next);
        if (most > std::max(now, then)) curve.push_back(place(most, top + row + 0.5));
    }
    Outline area;
    area.move_to(place(0, top));
    for (const glm::dvec2& point : curve) area.line_to(point);
    area.line_to(place(0, top + rows));
    Canvas& canvas = pen.canvas();
    const Paint faint = pen.style.line_paint(0.3);
    for (const double y : {top - t, top + rows})
        canvas.fill(Rectangle{at.x, at.y + y, base, t}, faint);
    canvas.fill(Rectangle{at.x, at.y + top, t, double(rows)}, faint);
    canvas.fill(area, pen.style.line_paint(0.2));
    for (std::size_t i = 1; i < curve.size(); ++i)
        canvas.line(curve[i - 1], curve[i], t, pen.style.line_paint());
    const double small = small_text * em, under = top + rows + t + 0.4 * em;
    const double figures = under + Font::capital_height(small);
    pen.text("1", at + glm::dvec2(0, figures), small);
    pen.text("0", at + glm::dvec2(base, figures), small, Align::right);
    pen.text(opacity_text, at + glm::dvec2(0, figures + text_line * small), small);
}

void Bar::draw_numbers(Pen& pen, const glm::dvec2& at) const {
    const double t = pen.style.thickness(em), start = left + width + t;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double y = std::round(row_of(values[i]));
        pen.canvas().fill(
            Rectangle{at.x + start, at.y + y - std::floor(t / 2), tick_length * em, t},
            pen.style.line_paint());
        pen.text_beside(numbers[i],
                        at + glm::dvec2(start + (tick_length + tick_gap) * em, y + t / 2), em);
    }
}

// Sets numbers and the values at which they stand: two or more, one for data of a single value, or
// none if two do not fit.
void set_numbers(Bar& bar, const std::string& format) {
    const auto text = [&](double value) {
        return format.empty() ? number_text(value) : formatted(format, value);
    };
    if (!(bar.range.hi > bar.range.lo)) {
        bar.values = {bar.range.lo};
        bar.numbers = {text(bar.range.lo)};
        return;
    }
    if (bar.rows < text_line * bar.em) return;
    const int most = static_cast<int>(bar.rows / (least_tick_distance * bar.em));
    const Ticks ticks = ticks_between(bar.range.lo, bar.range.hi, std::clamp(most, 2, most_ticks));
    const auto apart = [&](double a, double b) { return bar.row_of(a) - bar.row_of(b); };
    bar.values = ticks.values;
    if (bar.values.size() < 2 || apart(bar.values[0], bar.values[1]) < text_line * bar.em)
        bar.values = {bar.range.lo, bar.range.hi};
    else if (format.empty())
        bar.numbers = number_texts(bar.values, ticks.step);
    if (!bar.numbers.empty()) return;
    for (const double value : bar.values) bar.numbers.push_back(text(value));
}

// Returns a range without the values beyond the function's first and last point, which look alike,
// unless there is a step or nothing else.
BarRange where_it_changes(const TransferFunction& function, const BarRange& range) {
    const auto knots = function.knots();
    const auto step = [&](std::size_t i) { return knots[i].value == knots[i + 1].value; };
    if (knots.size() < 2) return range;
    const BarRange inner{
        step(0) ? range.lo : std::max(range.lo, knots.front().value),
        step(knots.size() - 2) ? range.hi : std::min(range.hi, knots.back().value)};
    return inner.lo < inner.hi ? inner : range;
}

}  // namespace

BarRange bar_range(const TransferFunction& transfer_function, const ValueRange& data) {
    if (data.empty()) return {};
    std::vector<double> ends{data.lo};
    for (const TransferKnot& knot : transfer_function.knots())
        if (knot.value > data.lo && knot.value < data.hi) ends.push_back(knot.value);
    ends.push_back(data.hi);
    BarRange range{INFINITY, -INFINITY};
    // The value between two ends, where neither a step nor a point is.
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double lo = ends[i - 1], hi = ends[i];
        if (!(transfer_function.at(lo + (hi - lo) / 2).extinction > 0)) continue;
        range.lo = std::min(range.lo, lo);
        range.hi = std::max(range.hi, hi);
    }
    return range.lo <= range.hi ? where_it_changes(transfer_function, range)
                                : BarRange{data.lo, data.hi};
}

double value_at(const BarRange& range, int row, int rows) {
    return range.hi - (range.hi - range.lo) * ((row + 0.5) / rows);
}

ColorBar color_bar(Pen& pen, const Annotation& wanted, const Scene& scene,
                   const AnnotatedData& data, double height) {
    const AnnotationStyle& style = pen.style;
    Bar bar{.function = *scene.transfer_function,
            .range = bar_range(*scene.transfer_function, data.range),
            .em = style.em * wanted.size};
    const double em = bar.em;
    bar.caption = caption_of(pen, wanted, data.quantity, em);
    const double largest = bar.function.max_extinction(bar.range.lo, bar.range.hi);
    double under = 0;
    if (largest > 0) {
        bar.length = length_of_opacity(scene, largest);
        bar.opacity_text =
            "opacity in " + length_text(bar.length, pen.fitted_name(data.length_unit, em));
        bar.left = static_cast<int>(std::round(curve_width * em));
        under = (0.4 + (1 + text_line) * small_text) * em;
    }
    bar.width = std::max(1, static_cast<int>(std::round(bar_width * em)));
    bar.top = std::round(em * (bar.caption.empty()
                                   ? 0.4
                                   : 0.2 + caption_gap + text_line * double(bar.caption.size())));
    const double rows = std::round(bar_share * wanted.size * style.height);
    const double others = bar.top + under + em;  // what the block has beside the bar
    const double free_rows = std::max(rows / 2, height - others);
    bar.rows = static_cast<int>(
        std::max(8.0, std::min({rows, free_rows, style.height - 2 * style.gap - others})));
    set_numbers(bar, wanted.format);

    Block block{"image.annotations.colorbar",
                wanted.position.value_or(AnnotationPosition::right),
                {},
                true,
                {}};
    double widest = 0;
    for (const std::string& number : bar.numbers) widest = std::max(widest, pen.width(number, em));
    block.size.x = bar.left + bar.width + (tick_length + tick_gap) * em + widest;
    for (const std::string& part : bar.caption)
        block.size.x = std::max(block.size.x, pen.width(part, em));
    if (!bar.opacity_text.empty())
        block.size.x = std::max(block.size.x, pen.width(bar.opacity_text, small_text * em));
    block.size = {std::ceil(block.size.x), std::ceil(bar.top + bar.rows + under + 0.4 * em)};
    block.draw = [bar](Pen& drawing, const glm::dvec2& at) { bar.draw(drawing, at); };
    std::vector<double> ticks;
    for (const double value : bar.values) ticks.push_back(bar.row_of(value));
    return {std::move(block),
            {double(bar.left), bar.top, double(bar.width), double(bar.rows)},
            bar.range,
            std::move(ticks)};
}

}  // namespace lamina
