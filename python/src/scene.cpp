// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "vectors.h"

namespace lamina::python {
namespace {

// `data`: a volume or a mesh in memory, or None.
Scene parsed(const std::string& json, const std::string& name, const py::object& data,
             const std::string& only_below) {
    if (py::isinstance<Volume>(data)) {
        const auto& volume = data.cast<const Volume&>();
        const py::gil_scoped_release released;
        return parse_scene(json, name, volume, only_below);
    }
    if (py::isinstance<MeshData>(data)) {
        const auto& mesh = data.cast<const MeshData&>();
        const py::gil_scoped_release released;
        return parse_scene(json, name, mesh, only_below);
    }
    const py::gil_scoped_release released;
    return parse_scene(json, name, std::filesystem::path(only_below));
}

std::string kind_word(const std::filesystem::path& file, const std::string& only_below) {
    switch (kind_of_file(file, only_below)) {
        case FileKind::scene:
            return "scene";
        case FileKind::volume:
            return "volume";
        case FileKind::mesh:
            return "mesh";
    }
    throw py::value_error("kind of file");
}

}  // namespace

void bind_scene(py::module_& module) {
    py::class_<Scene>(module, "Scene")
        .def_static("parse", &parsed, py::arg("json"), py::arg("name"),
                    py::arg("data") = py::none(), py::arg("only_below") = "")
        .def("text", &scene_text)
        .def_readonly("width", &Scene::width)
        .def_readonly("height", &Scene::height)
        .def_property_readonly("method", [](const Scene& scene) { return name_of(scene.method); })
        .def_property_readonly("color_space",
                               [](const Scene& scene) { return name_of(scene.color_space); })
        .def_property_readonly("background",
                               [](const Scene& scene) { return from_glm(scene.background); })
        .def_readonly("transparent", &Scene::transparent)
        .def_readonly("png_bits", &Scene::png_bits);
    module.def("kind_of_file", &kind_word, py::arg("file"), py::arg("only_below") = "");
}

}  // namespace lamina::python
