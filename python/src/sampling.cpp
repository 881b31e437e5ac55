// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "bindings.h"

namespace lamina::python {
namespace {

using Points = py::array_t<double, py::array::c_style>;

// Returns the values (n) and gradients (n, 3) at points (n, 3): NaN outside.
py::tuple sampled(const FieldSampler& field, const Points& points) {
    const py::ssize_t count = points.shape(0);
    py::array_t<double> values(count);
    py::array_t<double> gradients({count, py::ssize_t{3}});
    const double* const place = points.data();
    double* const value = values.mutable_data();
    double* const gradient = gradients.mutable_data();
    {
        const py::gil_scoped_release released;
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        for (py::ssize_t i = 0; i < count; ++i) {
            const double* const at = place + 3 * i;
            const FieldPoint found =
                field.at({at[0], at[1], at[2]}).value_or(FieldPoint{none, glm::dvec3(none)});
            value[i] = found.value;
            for (int c = 0; c < 3; ++c) gradient[3 * i + c] = found.gradient[c];
        }
    }
    return py::make_tuple(values, gradients);
}

}  // namespace

void bind_sampling(py::module_& module) {
    py::class_<FieldSampler>(module, "Sampler")
        .def_static(
            "of_volume", [](const Volume& volume) { return FieldSampler(volume); },
            py::arg("volume"))
        .def_static(
            "of_mesh",
            [](const MeshData& mesh, const std::string& scalar) {
                return FieldSampler(mesh, scalar);
            },
            py::arg("mesh"), py::arg("scalar"), py::call_guard<py::gil_scoped_release>())
        .def("at", &sampled, py::arg("points"));
}

}  // namespace lamina::python
