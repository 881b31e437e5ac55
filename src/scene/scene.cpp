// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "base/client.h"
#include "base/error.h"
#include "base/profile.h"
#include "mesh_files/mesh_file.h"
#include "meshing/volume_mesh.h"
#include "volume/generate.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

const VolumeFile& file_of_volume(const Scene& scene) {
    if (const VolumeFile* const file = scene.volume_file()) return *file;
    fail("no volume was given, and the scene names none");
}

std::string vector_text(const glm::dvec3& v) {
    return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

// Collects the first mistake of a lighting.
class Check {
  public:
    void number(const char* key, double found, double lo, double hi) {
        if (!(found >= lo && found <= hi))
            add(key, fmt::format("found {}, expected a number from {:g} to {:g}", found, lo, hi));
    }

    void light(std::size_t number, const Light& light) {
        const std::string path = fmt::format("lights.{}.", number);
        if (light.direction && !is_direction(*light.direction)) {
            add(path + "direction",
                fmt::format("found {}, expected \"headlight\" or a vector [x, y, z] that is not 0, "
                            "of coordinates up to 1e100",
                            vector_text(*light.direction)));
        }
        for (int c = 0; c < 3; ++c) {
            if (!(light.color[c] >= 0 && light.color[c] <= Lighting::largest_term)) {
                add(path + "color", fmt::format("found {}, expected components from 0 to {:g}",
                                                vector_text(light.color), Lighting::largest_term));
            }
        }
    }

    void add(const std::string& key, const std::string& message) {
        if (!first_) first_ = {key, message};
    }

    const std::optional<LightingMistake>& first() const { return first_; }

  private:
    static bool is_direction(const glm::dvec3& v) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(v[axis]) <= largest_scene_coordinate)) return false;
        }
        return v != glm::dvec3(0);
    }

    std::optional<LightingMistake> first_;
};

std::string list_names(const MeshData& data) {
    std::string names;
    for (const auto* scalars : {&data.point_scalars, &data.cell_scalars}) {
        for (const MeshScalar& scalar : *scalars)
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", scalar.name);
    }
    return names.empty() ? "none" : names;
}

// Tells whether a scalar has this name; a vector's length also has it with ".magnitude" added.
bool is_called(const MeshScalar& scalar, const std::vector<MeshScalar>& all,
               const std::string& name) {
    if (scalar.name == name) return true;
    return name == scalar.name + ".magnitude" &&
           std::ranges::count(all, scalar.name + ".x", &MeshScalar::name) > 0;
}

// Takes the scene's scalar out and drops all others. `averaged`: true if it comes from cells.
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
               cell != data.cell_scalars.end() &&
               (!scene.scalar.empty() || only_array(data.cell_scalars) != nullptr)) {
        taken = average_to_points(data.points.size(), data.tets, *cell, data.cell_of_tet);
        averaged = true;
    } else if (scene.scalar.empty()) {
        fail(
            "{}: has no scalar at points, and {} one array of cells; expected one, or \"scalar\" "
            "in "
            "the scene (--set scalar=NAME) to name an array of the file: {}",
            file, data.cell_scalars.empty() ? "not" : "more than", list_names(data));
    } else {
        fail("{}: scalar: found \"{}\", expected one that the file has: {}", file, scene.scalar,
             list_names(data));
    }
    data.point_scalars.clear();
    data.cell_scalars.clear();
    return taken;
}

}  // namespace

const char* name_of(Method method) {
    return word_of(method, {"slice", "project", "trace"});
}

const char* name_of(Target target) {
    return word_of(target, {"float32", "float16", "fixed16", "fixed8", "emulated"});
}

const char* name_of(TraceOf of) {
    return word_of(of, {"volume", "mesh"});
}

const char* name_of(NanPolicy policy) {
    return word_of(policy, {"error", "transparent"});
}

const char* name_of(Classification classification) {
    return word_of(classification, {"post", "preintegrated", "exact"});
}

const char* name_of(Order order) {
    return word_of(order, {"back_to_front", "front_to_back"});
}

const char* name_of(Filter filter) {
    return word_of(filter, {"exact", "hardware"});
}

const char* name_of(NodeArithmetic nodes) {
    return word_of(nodes, {"shader", "fixed"});
}

const char* name_of(NodeCode code) {
    return word_of(code, {"minimax", "phi", "alpha"});
}

const char* name_of(AlphaRounding rounding) {
    return word_of(rounding, {"truncate", "nearest", "stochastic"});
}

const char* name_of(OverRounding rounding) {
    return word_of(rounding, {"separate", "fused"});
}

const char* name_of(Coloring coloring) {
    return word_of(coloring, {"preintegrated", "attenuation", "vertex", "analytic"});
}

const char* name_of(Interpolation interpolation) {
    return word_of(interpolation, {"perspective", "linear"});
}

const char* name_of(Thickness thickness) {
    return word_of(thickness, {"exact", "dz"});
}

const char* name_of(ProjectOrder order) {
    return word_of(order, {"mpvo", "exact", "centroid", "none"});
}

const char* name_of(ProjectGeometry geometry) {
    return word_of(geometry, {"silhouette", "triangles"});
}

const char* name_of(ProjectDither dither) {
    return word_of(dither, {"none", "alpha", "after_blend"});
}

const char* name_of(LengthMapping mapping) {
    return word_of(mapping, {"octave", "log2", "linear"});
}

const char* name_of(TableStore store) {
    return word_of(store, {"mean_extinction", "opacity"});
}

const char* name_of(TableFormat format) {
    return word_of(format, {"fixed16", "fixed8", "float16", "float32"});
}

const char* name_of(TableConstruction construction) {
    return word_of(construction, {"exact", "incremental"});
}

Volume load_volume(const Scene& scene, const std::filesystem::path& only_below,
                   std::vector<std::string>* warnings) {
    const OnlyBelowScope scope(only_below);
    if (const auto* request = std::get_if<GeneratorRequest>(&scene.volume))
        return generate(*request);
    const VolumeFile& file = file_of_volume(scene);
    std::vector<std::string> said;
    return keep_warnings(warnings == nullptr ? said : *warnings,
                         [&] { return read_volume(file.path, file.selection); });
}

Volume open_volume(const Scene& scene) {
    if (const auto* request = std::get_if<GeneratorRequest>(&scene.volume))
        return generate(*request);
    const VolumeFile& file = file_of_volume(scene);
    return open_volume(
        file.path, file.selection,
        {.residence = VolumeUse::Residence::as_fits, .lit = scene.lighting.has_value()});
}

std::optional<LightingMistake> mistake_in(const Lighting& lighting) {
    Check check;
    check.number("ambient", lighting.ambient, 0, Lighting::largest_term);
    check.number("diffuse", lighting.diffuse, 0, Lighting::largest_term);
    check.number("specular", lighting.specular, 0, Lighting::largest_term);
    check.number("power", lighting.power, 1, Lighting::largest_power);
    if (lighting.smallest_gradient.is_given()) {
        check.number("smallest_gradient", *lighting.smallest_gradient, Lighting::least_gradient,
                     Lighting::largest_gradient);
    }
    const std::size_t lights = lighting.lights.size();
    if (lights < 1 || lights > Lighting::most_lights) {
        check.add("lights",
                  fmt::format("found {} lights, expected 1 to {}", lights, Lighting::most_lights));
    }
    for (std::size_t i = 0; i < lights; ++i) check.light(i, lighting.lights[i]);
    return check.first();
}

void check_lighting(const Scene& scene) {
    const Lighting* const lighting = given_lighting(scene.lighting);
    if (lighting == nullptr) return;
    if (const auto mistake = mistake_in(*lighting))
        fail("{}: lighting.{}: {}", scene.file.string(), mistake->key, mistake->message);
}

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
    Quantity quantity{scalar.name, {}};
    return {TetMesh(std::move(data), name_of_mesh(scene)),
            std::move(scalar),
            averaged,
            {},
            {},
            std::move(quantity)};
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
    return {TetMesh(std::move(data), name_of_mesh(scene)),
            std::move(scalar),
            false,
            report,
            {},
            volume.quantity(),
            volume.grid().unit};
}

SceneMesh load_mesh(const Scene& scene) {
    if (const MeshFile* const file = scene.mesh_file()) {
        Stage reading("read file");
        MeshData data = read_mesh(file->path, file->time, file->join);
        reading.end();
        return scene_mesh(scene, std::move(data));
    }
    Stage loading("load volume");
    const Volume volume = load_volume(scene);
    loading.end();
    return scene_mesh(scene, volume);
}

}  // namespace lamina
