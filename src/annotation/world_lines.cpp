// SPDX-License-Identifier: Apache-2.0
#include "annotation/world_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "annotation/numbers.h"
#include "base/client.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Whole 64ths of a pixel do not depend on the last bits of what a library computes.
double snapped(double pixels) {
    return std::round(64 * pixels) / 64;
}

// --- triad

constexpr double arrow_length = 2.3;  // in ems
// Display values of the axes' colours, x, y and z, on light and on dark paper: told apart with any
// colour vision by their lightness, too.
constexpr double dark_colors[3][3] = {{0.78, 0.12, 0.12}, {0.08, 0.5, 0.12}, {0.1, 0.25, 0.8}};
constexpr double light_colors[3][3] = {{1, 0.42, 0.4}, {0.45, 0.85, 0.4}, {0.5, 0.68, 1}};
// Opacity of arrows that point away from the viewer.
constexpr double away_opacity = 0.65;

std::array<const char*, 3> names_of(WorldAxes axes) {
    switch (axes) {
        case WorldAxes::named:
        case WorldAxes::unnamed:
            return {"x", "y", "z"};
        case WorldAxes::left_posterior_superior:
            return {"L", "P", "S"};
        case WorldAxes::right_anterior_superior:
            return {"R", "A", "S"};
        case WorldAxes::left_anterior_superior:
            return {"L", "A", "S"};
    }
    return {"x", "y", "z"};
}

struct Arrow {
    glm::dvec2 tip;  // pixels from the origin, y down
    double depth;    // above 0: away from the viewer
    glm::dvec3 color;
    const char* name;
};

void draw_arrow(Pen& pen, const glm::dvec2& origin, const Arrow& arrow, double em) {
    const double t = 1.6 * pen.style.thickness(em), length = glm::length(arrow.tip);
    const double opacity = arrow.depth > 0 ? away_opacity : 1;
    const Paint paint{arrow.color, opacity};
    const double least = 0.25 * em;  // shorter arrows, along the view, are dots
    const glm::dvec2 along = length > least ? arrow.tip / length : glm::dvec2(0);
    const glm::dvec2 across(-along.y, along.x);
    if (length > least) {
        const double head = std::min(0.7 * em, 0.6 * length), half = 0.45 * head;
        const glm::dvec2 neck = origin + (length - head) * along;
        Outline path;  // shaft and head are one shape, so that they do not darken each other
        path.move_to(origin - 0.5 * t * across);
        path.line_to(neck - 0.5 * t * across);
        path.line_to(neck - half * across);
        path.line_to(origin + arrow.tip);
        path.line_to(neck + half * across);
        path.line_to(neck + 0.5 * t * across);
        path.line_to(origin + 0.5 * t * across);
        pen.canvas().fill(path, paint);
    } else {
        pen.canvas().fill(disk_outline(origin, 0.22 * em), paint);
    }
    const glm::dvec2 beside = length > least ? along : glm::dvec2(0.7, 0.7);
    const glm::dvec2 place = origin + arrow.tip + 0.75 * em * beside;
    pen.text_beside(arrow.name, place, em, Align::center);
}

// --- box

constexpr double back_opacity = 0.35, front_opacity = 0.9;

struct Edge {
    int from, to, axis;
};

std::array<Edge, 12> edges_of_box() {
    std::array<Edge, 12> edges{};
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 8; ++corner)
            if ((corner >> axis & 1) == 0) edges[count++] = {corner, corner | 1 << axis, axis};
    }
    return edges;
}

// The box in the picture.
class SeenBox {
  public:
    SeenBox(const Scene& scene, const AnnotatedData& data)
        : view_(*scene.camera, scene.width, scene.height), window_(view_) {
        glm::dvec3 sum(0);
        for (std::size_t i = 0; i < 8; ++i) {
            seen_[i] = window_.see(data.corners[i]);
            sum += data.corners[i];
        }
        middle_ = sum / 8.0;
        for (int axis = 0; axis < 3; ++axis) {
            const glm::dvec3 step = data.corners[std::size_t{1} << axis] - data.corners[0];
            for (int side = 0; side < 2; ++side) front_[axis][side] = faces_eye(step, side);
        }
    }

    // Tells whether a face of the edge shows its outside.
    bool in_front(const Edge& edge) const { return count_of_front(edge) > 0; }
    // Tells whether the edge lies on the outline: one of its two faces shows its outside.
    bool on_outline(const Edge& edge) const { return count_of_front(edge) == 1; }

    // Returns the part of the edge in front of the eye and in the picture, in pixels; y down.
    std::optional<std::array<glm::dvec2, 2>> seen(const Edge& edge) const {
        glm::dvec3 a = seen_[static_cast<std::size_t>(edge.from)],
                   b = seen_[static_cast<std::size_t>(edge.to)];
        if (window_.perspective()) {
            const double near = least_depth * std::max({std::abs(a.z), std::abs(b.z), 1e-300});
            if (a.z < near && b.z < near) return std::nullopt;
            if (a.z < near) a += (near - a.z) / (b.z - a.z) * (b - a);
            if (b.z < near) b += (near - b.z) / (a.z - b.z) * (a - b);
        }
        return inside(place(a), place(b));
    }
    std::optional<glm::dvec2> corner(int number) const {
        const glm::dvec3& at = seen_[static_cast<std::size_t>(number)];
        if (window_.perspective() && !(at.z > 0)) return std::nullopt;
        const glm::dvec2 pixels = place(at);
        const bool shown =
            pixels.x >= 0 && pixels.y >= 0 && pixels.x <= view_.width && pixels.y <= view_.height;
        return shown ? std::optional(pixels) : std::nullopt;
    }
    std::optional<glm::dvec2> middle() const {
        const glm::dvec3 at = window_.see(middle_);
        if (window_.perspective() && !(at.z > 0)) return std::nullopt;
        return place(at);
    }

  private:
    // Share of an edge's depth at which it is cut off in front of the eye.
    static constexpr double least_depth = 1e-6;

    bool faces_eye(const glm::dvec3& step, int side) const {
        const glm::dvec3 outward = side == 0 ? -step : step;
        const glm::dvec3 on_face = middle_ + 0.5 * outward;
        const glm::dvec3 to_eye = window_.perspective() ? view_.eye - on_face : -view_.forward;
        return glm::dot(outward, to_eye) > 0;
    }
    int count_of_front(const Edge& edge) const {
        int count = 0;
        for (int axis = 0; axis < 3; ++axis)
            if (axis != edge.axis) count += front_[axis][edge.from >> axis & 1];
        return count;
    }
    glm::dvec2 place(const glm::dvec3& seen) const {
        const glm::dvec2 up = window_.to_window(seen);
        return {up.x, view_.height - up.y};
    }
    // Cuts a line off outside the picture and a margin (Liang and Barsky, 1984).
    std::optional<std::array<glm::dvec2, 2>> inside(const glm::dvec2& a,
                                                    const glm::dvec2& b) const {
        constexpr double margin = 16;
        const glm::dvec2 step = b - a;
        if (!(std::abs(step.x) < 1e15 && std::abs(step.y) < 1e15)) return std::nullopt;
        double first = 0, last = 1;
        const glm::dvec2 most(view_.width + margin, view_.height + margin);
        for (int axis = 0; axis < 2; ++axis) {
            if (step[axis] == 0) {
                if (a[axis] < -margin || a[axis] > most[axis]) return std::nullopt;
                continue;
            }
            const double low = (-margin - a[axis]) / step[axis];
            const double high = (most[axis] - a[axis]) / step[axis];
            first = std::max(first, std::min(low, high));
            last = std::min(last, std::max(low, high));
        }
        if (!(first < last)) return std::nullopt;
        const auto at = [&](double share) {
            const glm::dvec2 point = a + share * step;
            return glm::dvec2(snapped(point.x), snapped(point.y));
        };
        return std::array{at(first), at(last)};
    }

    View view_;
    WindowView window_;
    glm::dvec3 middle_{0};
    std::array<glm::dvec3, 8> seen_{};
    bool front_[3][2]{};
};

bool along_axes(const AnnotatedData& data) {
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 step = data.corners[std::size_t{1} << axis] - data.corners[0];
        for (int other = 0; other < 3; ++other)
            if (other != axis && std::abs(step[other]) > 1e-6 * std::abs(step[axis])) return false;
    }
    return true;
}

// Returns the edge of each axis that bears numbers: on the outline, the lowest in the picture.
std::optional<Edge> numbered_edge(const SeenBox& box, int axis) {
    std::optional<Edge> best;
    double lowest = -INFINITY;
    for (const Edge& edge : edges_of_box()) {
        if (edge.axis != axis || !box.on_outline(edge)) continue;
        const auto a = box.corner(edge.from), b = box.corner(edge.to);
        if (!a || !b) continue;
        if (a->y + b->y <= lowest) continue;
        lowest = a->y + b->y;
        best = edge;
    }
    return best;
}

// Returns a coordinate with as many digits as tell thousandths of an edge apart.
std::string coordinate_text(double value, double length) {
    const int digits = 3 - static_cast<int>(std::ceil(std::log10(length)));
    const double scale = std::pow(10, std::clamp(digits, -300, 300));
    return number_text(std::round(value * scale) / scale + 0.0);  // no -0
}

// Writes the numbers at the ends of an edge, and its name between them. Returns false if there is
// no room for them.
bool draw_numbers(Pen& pen, const Annotation& wanted, const SeenBox& box, const Edge& edge,
                  const AnnotatedData& data,
                  const std::function<bool(const std::vector<Rectangle>&)>& make_room) {
    const double em = 0.85 * pen.style.em * wanted.size;
    const glm::dvec2 a = *box.corner(edge.from), b = *box.corner(edge.to);
    if (glm::length(b - a) < 3.5 * em) return false;  // no room for two numbers and a name
    const glm::dvec2 middle = box.middle().value_or(0.5 * (a + b));
    const glm::dvec2 along = glm::normalize(b - a);
    glm::dvec2 outward(-along.y, along.x);
    if (glm::dot(outward, 0.5 * (a + b) - middle) < 0) outward = -outward;
    const glm::dvec3& from = data.corners[static_cast<std::size_t>(edge.from)];
    const glm::dvec3& to = data.corners[static_cast<std::size_t>(edge.to)];
    const bool coordinates = along_axes(data);
    const double low = coordinates ? from[edge.axis] : 0;
    const double high = coordinates ? to[edge.axis] : glm::distance(from, to);
    std::vector<std::pair<glm::dvec2, std::string>> texts;
    std::vector<Rectangle> places;
    const auto add = [&](const glm::dvec2& at, const std::string& text) {
        // Beside the line, as far as the text reaches towards it.
        const double half = 0.5 * pen.width(text, em);
        const double reach = std::abs(outward.x) * half + std::abs(outward.y) * 0.45 * em;
        const glm::dvec2 place = at + (reach + 0.5 * em) * outward;
        places.push_back({place.x - half, place.y - 0.5 * em, 2 * half, em});
        texts.emplace_back(glm::dvec2(snapped(place.x), snapped(place.y)), text);
    };
    const auto number = [&](double value) {
        return wanted.format.empty() ? coordinate_text(value, glm::distance(from, to))
                                     : formatted(wanted.format, value);
    };
    // Numbers of two edges that meet keep apart.
    const auto inset = [&](const std::string& text) {
        return (0.5 * pen.width(text, em) * std::abs(along.x) + 0.25 * em) * along;
    };
    const std::string first = number(low), last = number(high);
    add(a + inset(first), first);
    add(b - inset(last), last);
    if (overlap(places[0], places[1])) return false;
    std::string name(1, "xyz"[edge.axis]);
    if (!coordinates) name = "length";
    if (!data.length_unit.empty()) name += " (" + pen.fitted_name(data.length_unit, em) + ")";
    add(0.5 * (a + b), name);
    if (overlap(places[0], places[2]) || overlap(places[1], places[2])) {
        texts.pop_back();
        places.pop_back();
    }
    if (!make_room(places)) return false;
    for (const auto& [place, text] : texts) pen.text_beside(text, place, em, Align::center);
    return true;
}

}  // namespace

Block axes_triad(Pen& pen, const Annotation& wanted, const Scene& scene,
                 const AnnotatedData& data) {
    const double em = pen.style.em * wanted.size, reach = (arrow_length + 1.3) * em;
    Block block{"image.annotations.axes",
                wanted.position.value_or(AnnotationPosition::bottom_left),
                {},
                false,
                {}};
    block.size = block.largest = glm::dvec2(std::ceil(2 * reach));
    if (scene.camera.is_automatic()) return block;
    const View view(*scene.camera, scene.width, scene.height);
    std::array<Arrow, 3> arrows{};
    const auto names = names_of(data.axes);
    glm::dvec2 least(0), most(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto& shade = (pen.style.dark_ink ? dark_colors : light_colors)[axis];
        Arrow& arrow = arrows[static_cast<std::size_t>(axis)];
        arrow.tip = {snapped(arrow_length * em * view.right[axis]),
                     snapped(-arrow_length * em * view.up[axis])};
        arrow.depth = view.forward[axis];
        arrow.color = pen.style.shade({shade[0], shade[1], shade[2]});
        arrow.name = names[static_cast<std::size_t>(axis)];
        const double length = glm::length(arrow.tip);
        const glm::dvec2 name = arrow.tip * (length > 0 ? 1 + 0.75 * em / length : 1);
        least = glm::min(least, name - glm::dvec2(0.6 * em));
        most = glm::max(most, name + glm::dvec2(0.6 * em));
    }
    // The farthest one first.
    std::ranges::sort(arrows, [](const Arrow& a, const Arrow& b) { return a.depth > b.depth; });
    block.size = {std::ceil(most.x - least.x), std::ceil(most.y - least.y)};
    block.draw = [arrows, em, least](Pen& drawing, const glm::dvec2& at) {
        for (const Arrow& arrow : arrows) draw_arrow(drawing, at - least, arrow, em);
    };
    return block;
}

void draw_box(Pen& pen, const Annotation& wanted, const Scene& scene, const AnnotatedData& data,
              const std::function<bool(const std::vector<Rectangle>&)>& make_room) {
    const SeenBox box(scene, data);
    const double t = pen.style.thickness(pen.style.em * wanted.size);
    for (const bool front : {false, true}) {
        for (const Edge& edge : edges_of_box()) {
            if (box.in_front(edge) != front) continue;
            if (const auto line = box.seen(edge)) {
                pen.canvas().line((*line)[0], (*line)[1], t,
                                  pen.style.line_paint(front ? front_opacity : back_opacity));
            }
        }
    }
    std::string bare;
    for (int axis = 0; axis < 3; ++axis) {
        const auto edge = numbered_edge(box, axis);
        if (edge && draw_numbers(pen, wanted, box, *edge, data, make_room)) continue;
        bare += fmt::format("{}{}", bare.empty() ? "" : ", ", "xyz"[axis]);
    }
    if (bare.empty()) return;
    warn(fmt::format(
        "image.annotations.box: no numbers along {}: no outer edge that is whole in the "
        "picture has room for them",
        bare));
}

}  // namespace lamina
