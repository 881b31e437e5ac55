// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.h"
#include "lamina/scene.h"
#include "sample_hash.h"
#include "shared_array.h"
#include "vectors.h"

namespace lamina::python {
namespace {

// By number: equal types need not be one object.
template <typename Sample>
bool is_native(const py::dtype& type) {
    return type.num() == py::dtype::of<Sample>().num() && type.attr("isnative").cast<bool>();
}

std::optional<SampleType> sample_type(const py::dtype& type) {
    if (is_native<std::uint8_t>(type)) return SampleType::uint8;
    if (is_native<std::int16_t>(type)) return SampleType::int16;
    if (is_native<std::uint16_t>(type)) return SampleType::uint16;
    if (is_native<float>(type)) return SampleType::float32;
    return std::nullopt;
}

Centering centering_of(const std::string& word) {
    if (word == "node") return Centering::node;
    if (word == "cell") return Centering::cell;
    throw py::value_error("centers: found \"" + word + "\", expected \"node\" or \"cell\"");
}

VolumeLookup lookup_of(const std::string& word) {
    if (word == "linear") return VolumeLookup::linear;
    if (word == "nearest") return VolumeLookup::nearest;
    throw py::value_error("lookup: found \"" + word + "\", expected \"linear\" or \"nearest\"");
}

Grid grid_over(const py::array& array, const std::array<Vector, 3>& steps, const Vector& origin,
               const std::array<std::string, 3>& centers) {
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = array.shape(static_cast<py::ssize_t>(2 - axis));
        grid.step[axis] = to_glm(steps[axis]);
        grid.centering[axis] = centering_of(centers[axis]);
    }
    grid.origin = to_glm(origin);
    return grid;
}

// The array is C contiguous, z first; the package's Python code has made it so.
Volume volume_over(const py::array& array, const std::array<Vector, 3>& steps, const Vector& origin,
                   const std::array<std::string, 3>& centers, const std::string& lookup,
                   const std::string& unit) {
    const auto type = sample_type(array.dtype());
    if (!type || array.ndim() != 3 || (array.flags() & py::array::c_style) == 0)
        throw py::type_error("expected a contiguous array [z, y, x] of a type that is drawn");
    Grid grid = grid_over(array, steps, origin, centers);
    grid.lookup = lookup_of(lookup);
    grid.unit = unit;
    return {grid, *type, keep(array, array.data())};
}

// Returns a volume of labels, and the warnings. The array is as for volume_over(), of any type that
// files have.
std::pair<Volume, std::vector<std::string>> labels_over(const py::array& array,
                                                        const std::string& type,
                                                        const std::array<Vector, 3>& steps,
                                                        const Vector& origin,
                                                        const std::array<std::string, 3>& centers) {
    if (array.ndim() != 3 || (array.flags() & py::array::c_style) == 0)
        throw py::type_error("expected a contiguous array [z, y, x]");
    const Grid grid = grid_over(array, steps, origin, centers);
    std::shared_ptr<const void> samples = keep(array, array.data());
    std::vector<std::string> warnings;
    const py::gil_scoped_release free;
    Volume volume = label_volume(grid, type, std::move(samples), &warnings);
    return {std::move(volume), std::move(warnings)};
}

py::array array_of(const Volume& volume) {
    const auto& samples = volume.grid().size;
    return volume.visit([&](const auto* first) {
        return constant_array_over(first, {samples[2], samples[1], samples[0]},
                                   std::make_shared<Volume>(volume));
    });
}

py::tuple bounds_of(const Volume& volume) {
    const Grid::Bounds bounds = volume.grid().bounds();
    return py::make_tuple(from_glm(bounds.min), from_glm(bounds.max));
}

std::array<Vector, 3> steps_of(const Volume& volume) {
    const auto& step = volume.grid().step;
    return {from_glm(step[0]), from_glm(step[1]), from_glm(step[2])};
}

std::array<std::string, 3> centers_of(const Volume& volume) {
    std::array<std::string, 3> words;
    for (std::size_t axis = 0; axis < 3; ++axis)
        words[axis] = volume.grid().centering[axis] == Centering::node ? "node" : "cell";
    return words;
}

// Returns code, number and name of each label.
std::vector<std::tuple<int, std::string, std::string>> labels_of(const Volume& volume) {
    std::vector<std::tuple<int, std::string, std::string>> list;
    if (!volume.labels()) return list;
    for (const Label& label : volume.labels()->list)
        list.emplace_back(static_cast<int>(label.code), label.number, label.name);
    return list;
}

}  // namespace

void bind_volume(py::module_& module) {
    module.attr("sample_parts") = sample_parts;
    module.def(
        "describe_file",
        [](const std::filesystem::path& file, const std::string& scene,
           const std::string& only_below) {
            VolumeRequest request;
            if (!scene.empty()) {
                const Scene read = parse_scene(scene, "lamina.info", only_below);
                if (read.volume_file() != nullptr) request = read.volume_file()->selection;
                if (read.mesh_file() != nullptr) request.time = read.mesh_file()->time;
            }
            std::vector<std::string> warnings;
            std::string text = describe_file(file, request, only_below, &warnings);
            return std::pair(std::move(text), std::move(warnings));
        },
        py::arg("file"), py::arg("scene"), py::arg("only_below"),
        py::call_guard<py::gil_scoped_release>());
    module.def(
        "hash_of_part",
        [](const py::array& array, std::size_t part) {
            const auto* const samples = static_cast<const char*>(array.data());
            const auto bytes = static_cast<std::size_t>(array.nbytes());
            const py::gil_scoped_release free;
            return hash_of_part(samples, bytes, part);
        },
        py::arg("array"), py::arg("part"));
    py::class_<Volume>(module, "Volume")
        .def_static("over", &volume_over, py::arg("array"), py::arg("steps"), py::arg("origin"),
                    py::arg("centers"), py::arg("lookup") = "linear", py::arg("unit") = "")
        .def("look_like_labels", &look_like_labels, py::call_guard<py::gil_scoped_release>())
        .def_static("labels_over", &labels_over, py::arg("array"), py::arg("type"),
                    py::arg("steps"), py::arg("origin"), py::arg("centers"))
        .def_static(
            "load",
            [](const std::string& scene, const std::string& only_below) {
                const Scene read =
                    parse_scene(scene, "lamina.read", std::filesystem::path(only_below));
                std::vector<std::string> warnings;
                Volume volume = load_volume(read, only_below, &warnings);
                return std::pair(std::move(volume), std::move(warnings));
            },
            py::arg("scene"), py::arg("only_below") = "", py::call_guard<py::gil_scoped_release>())
        .def(
            "save",
            [](const Volume& volume, const std::filesystem::path& file) {
                save_volume(volume, file);
            },
            py::arg("file"), py::call_guard<py::gil_scoped_release>())
        .def_property_readonly("array", &array_of)
        .def_property_readonly("steps", &steps_of)
        .def_property_readonly("origin",
                               [](const Volume& volume) { return from_glm(volume.grid().origin); })
        .def_property_readonly("centers", &centers_of)
        .def_property_readonly("lookup",
                               [](const Volume& volume) {
                                   const bool linear = volume.grid().lookup == VolumeLookup::linear;
                                   return std::string(linear ? "linear" : "nearest");
                               })
        .def_property_readonly("unit", [](const Volume& volume) { return volume.grid().unit; })
        .def_property_readonly("labels", &labels_of)
        .def(
            "with_labels_of",
            [](const Volume& volume, const Volume& other) {
                return volume.labelled(other.labels());
            },
            py::arg("other"))
        .def_property_readonly("bounds", &bounds_of);
}

}  // namespace lamina::python
