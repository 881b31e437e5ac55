// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <optional>

#include "bindings.h"
#include "lamina/scene.h"
#include "shared_array.h"
#include "waiting.h"

namespace lamina::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style>;
using Corners = py::array_t<std::int32_t, py::array::c_style>;
using Scalars = std::vector<std::pair<std::string, Numbers>>;
using SharedMesh = std::shared_ptr<MeshData>;

std::vector<MeshScalar> copies_of(const Scalars& scalars) {
    std::vector<MeshScalar> copies;
    for (const auto& [name, values] : scalars)
        copies.push_back({name, {values.data(), values.data() + values.size()}});
    return copies;
}

// The package's Python code has checked shapes and indices.
SharedMesh mesh_of(const Numbers& points, const Corners& tets, const Scalars& at_points,
                   const Scalars& at_tets) {
    static_assert(sizeof(glm::dvec3) == 3 * sizeof(double));
    static_assert(sizeof(Tet) == 4 * sizeof(std::int32_t));
    auto mesh = std::make_shared<MeshData>();
    mesh->points.resize(static_cast<std::size_t>(points.shape(0)));
    std::memcpy(mesh->points.data(), points.data(), static_cast<std::size_t>(points.nbytes()));
    mesh->tets.resize(static_cast<std::size_t>(tets.shape(0)));
    std::memcpy(mesh->tets.data(), tets.data(), static_cast<std::size_t>(tets.nbytes()));
    mesh->point_scalars = copies_of(at_points);
    mesh->cell_scalars = copies_of(at_tets);
    return mesh;
}

py::array points_of(const SharedMesh& mesh) {
    return constant_array_over(reinterpret_cast<const double*>(mesh->points.data()),
                               {static_cast<py::ssize_t>(mesh->points.size()), 3}, mesh);
}

py::array tets_of(const SharedMesh& mesh) {
    return constant_array_over(reinterpret_cast<const std::int32_t*>(mesh->tets.data()),
                               {static_cast<py::ssize_t>(mesh->tets.size()), 4}, mesh);
}

py::dict scalars_of(const SharedMesh& mesh, const std::vector<MeshScalar>& scalars) {
    py::dict found;
    for (const MeshScalar& scalar : scalars) {
        found[py::str(scalar.name)] = constant_array_over(
            scalar.values.data(), {static_cast<py::ssize_t>(scalar.values.size())}, mesh);
    }
    return found;
}

py::dict report_of(const MeshReport& report) {
    py::dict found;
    found["tets"] = report.tets;
    found["kuhn_tets"] = report.kuhn_tets;
    found["error"] = report.error;
    found["relative_error"] = report.relative_error();
    found["within_tolerance"] = report.within_tolerance;
    found["stopped_by_max_tets"] = report.stopped_by_max_tets;
    return found;
}

// `scene`: where its transfer function shows nothing, the mesh may be coarse; or None.
py::tuple make(const Volume& volume, double tolerance, std::int64_t max_tets, bool kuhn,
               const py::object& scene, const py::object& progress) {
    const Scene* const shown = scene.is_none() ? nullptr : &scene.cast<const Scene&>();
    MadeMesh made;
    run_waiting(
        [&](std::stop_token stop, const ProgressCallback& said) {
            std::optional<TransferFunction> transfer_function;
            if (shown != nullptr) transfer_function = chosen_transfer_function(*shown, volume);
            made = make_mesh(volume, {tolerance, max_tets, kuhn},
                             transfer_function ? &*transfer_function : nullptr, stop, said);
        },
        progress);
    return py::make_tuple(std::make_shared<MeshData>(std::move(made.mesh)), report_of(made.report));
}

}  // namespace

void bind_mesh(py::module_& module) {
    py::class_<MeshData, SharedMesh>(module, "Mesh")
        .def_static("of", &mesh_of, py::arg("points"), py::arg("tets"), py::arg("at_points"),
                    py::arg("at_tets"))
        .def_static(
            "load",
            [](const std::filesystem::path& file, const std::string& only_below) {
                return std::make_shared<MeshData>(load_mesh_data(file, only_below));
            },
            py::arg("file"), py::arg("only_below") = "", py::call_guard<py::gil_scoped_release>())
        .def(
            "save",
            [](const MeshData& mesh, const std::filesystem::path& file) { save_mesh(mesh, file); },
            py::arg("file"), py::call_guard<py::gil_scoped_release>())
        .def_property_readonly("points", &points_of)
        .def_property_readonly("tets", &tets_of)
        .def_property_readonly(
            "point_scalars",
            [](const SharedMesh& mesh) { return scalars_of(mesh, mesh->point_scalars); })
        .def_property_readonly("cell_scalars", [](const SharedMesh& mesh) {
            return scalars_of(mesh, mesh->cell_scalars);
        });
    module.def("make_mesh", &make, py::arg("volume"), py::arg("tolerance"), py::arg("max_tets"),
               py::arg("kuhn"), py::arg("scene"), py::arg("progress"));
}

}  // namespace lamina::python
