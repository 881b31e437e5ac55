// SPDX-License-Identifier: Apache-2.0
#include "annotation/scale_bar.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "annotation/numbers.h"
#include "scene/camera.h"

namespace lamina {
namespace {

constexpr double longest_bar = 0.25;  // longest bar, as a share of the picture's width
// In ems: the height of the bar's end marks, and the distance of the text from them.
constexpr double mark_height = 0.5, text_gap = 0.35;

std::string text_of(const Annotation& wanted, const Scene& scene, const std::string& unit,
                    double length) {
    const std::string own = length == 1 ? "unit" : "units";
    std::string text = number_text(length) + " " + (unit.empty() ? own : unit);
    if (!wanted.format.empty()) text = formatted(wanted.format, length);
    const bool perspective = scene.camera->projection == Projection::perspective;
    return perspective ? text + " at the centre" : text;
}

}  // namespace

Scale scale_of(const Scene& scene, double most) {
    const View view(*scene.camera, scene.width, scene.height);
    const double depth = view.projection == Projection::perspective
                             ? glm::dot(scene.camera->center - view.eye, view.forward)
                             : 1;
    const double pixel = view.pixel * depth;  // edge of a pixel, in world units
    const double length = round_number_up_to(most * pixel);
    return {length, length / pixel};
}

Block scale_bar(Pen& pen, const Annotation& wanted, const Scene& scene, const AnnotatedData& data) {
    const double em = pen.style.em * wanted.size;
    Block block{"image.annotations.scale_bar",
                wanted.position.value_or(AnnotationPosition::bottom_right),
                {},
                true,
                {}};
    block.size.y = std::ceil((1.2 + text_gap + mark_height) * em);
    // Before the camera is chosen, only the height matters: the block takes room below the data.
    if (scene.camera.is_automatic()) return block;
    const Scale scale = scale_of(scene, longest_bar * pen.style.width);
    const std::string text =
        text_of(wanted, scene, pen.fitted_name(data.length_unit, em), scale.length);
    block.size.x = std::ceil(std::max(scale.pixels, pen.width(text, em)));
    block.draw = [em, text, scale, width = block.size.x](Pen& drawing, const glm::dvec2& corner) {
        const double middle = corner.x + width / 2, top = std::round(corner.y);
        drawing.text(text, {middle, top + 0.95 * em}, em, Align::center);
        const double t = std::round(1.5 * drawing.style.thickness(em));
        const double left = middle - scale.pixels / 2, high = top + (1.2 + text_gap) * em;
        const double mark = std::round(mark_height * em), y = std::round(high + (mark - t) / 2);
        Canvas& canvas = drawing.canvas();
        const Paint paint = drawing.style.line_paint();
        // The marks lie inside of the length.
        canvas.fill(Rectangle{left, y, scale.pixels, t}, paint);
        canvas.fill(Rectangle{left, std::round(high), t, mark}, paint);
        canvas.fill(Rectangle{left + scale.pixels - t, std::round(high), t, mark}, paint);
    };
    return block;
}

}  // namespace lamina
