// SPDX-License-Identifier: Apache-2.0
#include "drawn.h"

#include "shared_array.h"

namespace lamina::python {
namespace {

template <typename Real>
py::array array_of(const std::shared_ptr<RgbaImage<Real>>& image) {
    const Real* const first = image->rgba.data();
    return array_over(first, {image->height, image->width, 4}, image);
}

py::list omissions_of(const Drawn& drawn) {
    py::list omissions;
    for (const auto& [name, reason] : drawn.plan.left_out)
        omissions.append(py::make_tuple(name, reason));
    return omissions;
}

std::optional<py::array> annotations_of(const Drawn& drawn) {
    const std::shared_ptr<const Image>& layer = drawn.annotations();
    if (!layer) return std::nullopt;
    return constant_array_over(layer->rgba.data(), {layer->height, layer->width, 4}, layer);
}

py::dict statistics_of(const Drawn& drawn) {
    const FrameStatistics& found = drawn.statistics;
    py::dict statistics;
    statistics["drawn_by"] = found.drawn_by;
    statistics["draw_ms"] = found.draw_ms;
    statistics["stages_ms"] = found.stages_ms;
    statistics["fragments"] = found.fragments;
    statistics["bytes"] = found.bytes;
    return statistics;
}

}  // namespace

py::array Drawn::array() const {
    return truth ? array_of(truth) : array_of(picture);
}

std::optional<double> Drawn::error() const {
    return is_traced() ? statistics.trace_error : plan.error.known();
}

std::string Drawn::error_kind() const {
    return is_traced() ? "estimated" : name_of(plan.error.kind);
}

std::optional<double> Drawn::error_along_ramps() const {
    if (is_traced() || plan.error.along_ramps == 0) return std::nullopt;
    return plan.error.along_ramps;
}

void bind_drawn(py::module_& module) {
    py::class_<Drawn>(module, "Drawn")
        .def_property_readonly("array", &Drawn::array)
        .def_property_readonly("annotations", &annotations_of)
        .def_property_readonly("error", &Drawn::error)
        .def_property_readonly("error_kind", &Drawn::error_kind)
        .def_property_readonly("error_along_ramps", &Drawn::error_along_ramps)
        .def_readonly("scene", &Drawn::scene)
        .def_property_readonly("traced", [](const Drawn& drawn) { return drawn.truth != nullptr; })
        .def_property_readonly("target",
                               [](const Drawn& drawn) { return name_of(drawn.plan.target); })
        .def_property_readonly("slabs", [](const Drawn& drawn) { return drawn.plan.slabs; })
        .def_property_readonly("omitted", &omissions_of)
        .def_property_readonly("statistics", &statistics_of)
        .def_readonly("explanation", &Drawn::explanation)
        .def_readonly("warnings", &Drawn::warnings);
}

}  // namespace lamina::python
