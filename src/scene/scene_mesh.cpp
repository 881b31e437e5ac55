// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_mesh.h"

#include <algorithm>

#include "base/error.h"
#include "base/profile.h"
#include "mesh/tet_mesh.h"
#include "mesh_files/mesh_file.h"
#include "meshing/volume_mesh.h"

namespace lamina {
namespace {

std::string list_names(const MeshData& data) {
    std::string names;
    for (const auto* scalars : {&data.point_scalars, &data.cell_scalars}) {
        for (const MeshScalar& scalar : *scalars)
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", scalar.name);
    }
    return names.empty() ? "none" : names;
}

// Tells whether a scalar has this name. NAME.magnitude is another word for a vector's NAME, which
// stands for its length.
bool is_called(const MeshScalar& scalar, const std::vector<MeshScalar>& all,
               const std::string& name) {
    if (scalar.name == name) return true;
    return name == scalar.name + ".magnitude" &&
           std::ranges::count(all, scalar.name + ".x", &MeshScalar::name) > 0;
}

// Takes the scalar out of the data and drops all others.
MeshScalar take_scalar(MeshData& data, const Scene& scene, bool& averaged) {
    const std::string file = name_of_mesh(scene);
    const auto find = [&](std::vector<MeshScalar>& scalars) {
        return std::find_if(scalars.begin(), scalars.end(), [&](const MeshScalar& scalar) {
            return scene.scalar.empty() || is_called(scalar, scalars, scene.scalar);
        });
    };
    MeshScalar taken;
    if (const auto point = find(data.point_scalars); point != data.point_scalars.end()) {
        taken = std::move(*point);
    } else if (const auto cell = find(data.cell_scalars);
               cell != data.cell_scalars.end() && !scene.scalar.empty()) {
        taken = average_to_points(data.points.size(), data.tets, *cell);
        averaged = true;
    } else if (scene.scalar.empty()) {
        fail(
            "{}: has no point scalars; expected one, or \"scalar\" in the scene to name an array "
            "of "
            "the file: {}",
            file, list_names(data));
    } else {
        fail("{}: scalar: found \"{}\", expected one that the file has: {}", file, scene.scalar,
             list_names(data));
    }
    data.point_scalars.clear();
    data.cell_scalars.clear();
    return taken;
}

}  // namespace

std::vector<glm::dvec3> gradients_of(const SceneMesh& mesh) {
    if (!mesh.gradients_before_clip.empty()) return mesh.gradients_before_clip;
    return point_gradients(mesh.mesh, mesh.scalar.values);
}

MeshSettings mesh_settings(const Scene& scene) {
    const MeshSettings* const given = scene.made_mesh();
    return given != nullptr ? *given : MeshSettings{};
}

std::string name_of_mesh(const Scene& scene) {
    if (const MeshFile* const file = scene.mesh_file()) return file->path.string();
    return scene.file.empty() ? "mesh" : scene.file.string() + ": mesh";
}

SceneMesh scene_mesh(const Scene& scene, MeshData data) {
    bool averaged = false;
    MeshScalar scalar = take_scalar(data, scene, averaged);
    const Stage matching("neighbours");
    return {TetMesh(std::move(data), name_of_mesh(scene)), std::move(scalar), averaged, {}};
}

SceneMesh scene_mesh(const Scene& scene, const Volume& volume) {
    MeshReport report;
    MeshData data;
    try {
        const Stage making("make mesh");
        data = make_volume_mesh(volume, mesh_settings(scene), &*scene.transfer_function, report);
    } catch (const Error& error) {
        fail("{}: {}", name_of_mesh(scene), error.what());
    }
    MeshScalar scalar = std::move(data.point_scalars.front());
    data.point_scalars.clear();
    const Stage matching("neighbours");
    return {TetMesh(std::move(data), name_of_mesh(scene)), std::move(scalar), false, report};
}

SceneMesh load_mesh(const Scene& scene) {
    if (const MeshFile* const file = scene.mesh_file()) {
        Stage reading("read file");
        MeshData data = read_mesh(file->path, file->time);
        reading.end();
        return scene_mesh(scene, std::move(data));
    }
    Stage loading("load volume");
    const Volume volume = load_volume(scene);
    loading.end();
    return scene_mesh(scene, volume);
}

}  // namespace lamina
