// SPDX-License-Identifier: Apache-2.0
#include "study/data_store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <glm/vec3.hpp>
#include <utility>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/profile.h"
#include "choice/choose.h"
#include "mesh_files/mesh_file.h"
#include "scene/given_transfer.h"
#include "scene/half_space.h"
#include "scene_files/data_keys.h"
#include "study/result_files.h"
#include "volume/generate.h"
#include "volume/volume_store.h"

namespace lamina::study {
namespace {

void add(ContentHash& hash, const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) hash.add(v[i]);
}

void add(ContentHash& hash, const Lighting& lighting) {
    for (const double number : {lighting.ambient, lighting.diffuse, lighting.specular,
                                lighting.power, lighting.smallest_gradient.value_or(0)})
        hash.add(number);
    for (const Light& light : lighting.lights) {
        add(hash, light.direction.value_or(glm::dvec3(0)));
        add(hash, light.color);
    }
}

}  // namespace

std::string picture_key(const Scene& scene) {
    ContentHash hash;
    const Camera& camera = *scene.camera;
    hash.add(static_cast<double>(camera.projection));
    hash.add(camera.projection == Projection::perspective ? camera.fov_y : camera.height);
    hash.add(scene.width);
    hash.add(scene.height);
    add(hash, camera.eye);
    add(hash, camera.center);
    add(hash, camera.up);
    assert(!has_open_colormap(scene));
    hash.add(transfer_function_key(*scene.transfer_function));
    for (const HalfSpace& half : half_spaces(scene.clip)) {
        add(hash, half.point);
        add(hash, half.normal);
    }
    if (scene.lighting) add(hash, *scene.lighting);
    return hash.hex();
}

std::string transfer_function_key(const TransferFunction& transfer_function) {
    ContentHash hash;
    for (const TransferKnot& knot : transfer_function.knots()) {
        hash.add(knot.value);
        add(hash, knot.optics.color);
        hash.add(knot.optics.extinction);
        if (knot.smooth) hash.add("smooth");
    }
    return hash.hex();
}

std::string content_of(const Volume& volume) {
    ContentHash hash;
    const Grid& grid = volume.grid();
    hash.add(name_of(volume.type()));
    add(hash, grid.origin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        add(hash, grid.step[axis]);
        hash.add(static_cast<double>(grid.size[axis]));
        hash.add(static_cast<double>(grid.centering[axis]));
    }
    if (volume.in_memory())
        hash.add(volume.data(), volume.byte_count());
    else
        hash.add(volume.store().source().identity());
    return hash.hex();
}

std::string content_of(const SceneMesh& mesh) {
    ContentHash hash;
    const auto add_all = [&](const auto& values) {
        hash.add(values.data(), values.size() * sizeof(values[0]));
    };
    add_all(mesh.mesh.points());
    add_all(mesh.mesh.tets());
    add_all(mesh.scalar.values);
    return hash.hex();
}

std::string content_of(const Colormap& colormap) {
    ContentHash hash;
    hash.add(static_cast<double>(colormap.colors.size()));
    for (const ColorPoint& point : colormap.colors) {
        hash.add(point.value);
        add(hash, point.color);
    }
    for (const OpacityPoint& point : colormap.opacities) {
        hash.add(point.value);
        hash.add(point.opacity);
    }
    return hash.hex();
}

TracedMesh::TracedMesh(SceneMesh mesh)
    : TracedMesh(SceneData(std::make_shared<const SceneMesh>(std::move(mesh)))) {}

TracedMesh::TracedMesh(SceneData data) : data_(std::move(data)), mesh_(data_.mesh({})) {
    data_.open_faces({});
}

TracedPicture TracedMesh::trace(const Scene& scene) {
    return trace_picture(as_trace(scene, TraceOf::mesh), data_);
}

const PreciseImage& TracedMesh::exact(const Scene& scene) {
    const std::string key = picture_key(scene);
    const auto found = traced_.find(key);
    if (found != traced_.end()) return found->second;
    return traced_.emplace(key, trace(scene).image).first->second;
}

namespace {

nlohmann::ordered_json facts_of(const SceneMesh& mesh, double ms) {
    const MeshReport& report = mesh.report.value();
    return {{"mesh", content_of(mesh)},
            {"ms", ms},
            {"points", report.points},
            {"tets", report.tets},
            {"kuhn_tets", report.kuhn_tets},
            {"rounds", report.rounds},
            {"range", report.range},
            {"error", report.error},
            {"within_tolerance", report.within_tolerance},
            {"stopped_by_max_tets", report.stopped_by_max_tets}};
}

MeshReport report_from(const nlohmann::json& facts) {
    MeshReport report;
    facts.at("points").get_to(report.points);
    facts.at("tets").get_to(report.tets);
    facts.at("kuhn_tets").get_to(report.kuhn_tets);
    facts.at("rounds").get_to(report.rounds);
    facts.at("range").get_to(report.range);
    facts.at("error").get_to(report.error);
    facts.at("within_tolerance").get_to(report.within_tolerance);
    facts.at("stopped_by_max_tets").get_to(report.stopped_by_max_tets);
    return report;
}

}  // namespace

std::optional<MadeMesh> KeptMeshes::find(const std::string& id, const Scene& scene) const {
    if (!std::filesystem::exists(file(id, ".json"))) return std::nullopt;
    try {
        const nlohmann::json facts = load_json(file(id, ".json"));
        Scene whole = scene;
        whole.scalar.clear();  // the file has one
        MadeMesh made{SceneData(whole, read_mesh(file(id, ".vtu")), report_from(facts)),
                      facts.at("ms").get<double>()};
        if (content_of(*made.data.mesh(whole)) != facts.at("mesh").get<std::string>())
            return std::nullopt;
        return made;
    } catch (const Error&) {
    } catch (const nlohmann::json::exception&) {
    }
    return std::nullopt;
}

// The mesh is written before the facts: a mesh with a .json is complete.
void KeptMeshes::keep(const std::string& id, MadeMesh& made) const {
    const SceneMesh& drawn = *made.data.mesh({});
    const TetMesh& tets = drawn.mesh;
    MeshData data;
    data.points.assign(tets.points().begin(), tets.points().end());
    data.tets.assign(tets.tets().begin(), tets.tets().end());
    data.point_scalars = {drawn.scalar};
    AtomicFile mesh(file(id, ".vtu"));
    write_vtu(mesh, data);
    mesh.commit();
    write_text(file(id, ".json"), json_text(facts_of(drawn, made.ms)) + "\n");
}

std::string volume_name(const Scene& scene) {
    if (const VolumeFile* const file = scene.volume_file()) {
        const std::string path = file->path.string();
        if (file->selection == VolumeRequest{}) return path;
        return json_text(volume_selection_json(path, file->selection));
    }
    const auto& request = std::get<GeneratorRequest>(scene.volume);
    const auto size = generated_grid(request).size;
    return fmt::format("{} {} {}", request.name, fmt::join(size, "x"), name_of(request.type));
}

// The name includes the transfer function: a mesh made from a volume stays coarse in parts that
// show nothing.
std::string mesh_name(const Scene& scene) {
    if (const MeshFile* const file = scene.mesh_file()) {
        std::string name = file->path.string();
        if (file->time != 0) name += fmt::format(" {}", file->time);
        return scene.scalar.empty() ? name : name + " " + scene.scalar;
    }
    const MeshSettings settings = mesh_settings(scene);
    return fmt::format("{} {} {} {} {}", volume_name(scene), settings.tolerance, settings.max_tets,
                       settings.kuhn, transfer_function_key(*scene.transfer_function));
}

const DataStore::StoredVolume& DataStore::volume(const Scene& scene) {
    std::unique_ptr<StoredVolume>& stored = volumes_[volume_name(scene)];
    if (!stored) {
        std::shared_ptr<const VolumeData> data = SceneData().volume(scene);
        std::string content = content_of(data->volume);
        stored = std::make_unique<StoredVolume>(StoredVolume{std::move(data), std::move(content)});
    }
    return *stored;
}

DataStore::StoredMesh& DataStore::mesh(const Scene& scene) {
    std::unique_ptr<StoredMesh>& stored = meshes_[mesh_name(scene)];
    if (!stored) {
        MadeMesh made = read_or_make(scene);
        TracedMesh data(std::move(made.data));
        std::string content = content_of(data.mesh());
        stored =
            std::make_unique<StoredMesh>(StoredMesh{std::move(data), std::move(content), made.ms});
    }
    return *stored;
}

MadeMesh DataStore::read_or_make(const Scene& scene) {
    const auto make = [&] {
        const bool makes = scene.mesh_file() == nullptr;
        SceneData data = makes ? SceneData(volume(scene).data, nullptr) : SceneData();
        const Stopwatch watch;
        data.mesh(scene);
        return MadeMesh{std::move(data), watch.milliseconds()};
    };
    if (!kept_ || scene.mesh_file() != nullptr) return make();
    // Data of the volume's name may change between two processes.
    ContentHash id;
    id.add(volume(scene).content);
    id.add(mesh_name(scene));
    if (std::optional<MadeMesh> found = kept_->find(id.hex(), scene)) return std::move(*found);
    MadeMesh made = make();
    kept_->keep(id.hex(), made);
    return made;
}

// If the scene leaves something open, the volume decides on it even if a mesh is made from it.
SceneData DataStore::data_of(const Scene& scene) {
    if (!scene.draws_mesh()) return SceneData(volume(scene).data);
    const SceneData& data = mesh(scene).data.data();
    if (scene.mesh_file() != nullptr || !leaves_something_open(scene)) return data;
    return SceneData(volume(scene).data, SceneData(data).mesh(scene));
}

Scene DataStore::closed(Scene scene) {
    if (!has_open_colormap(scene)) return scene;
    SceneData data = scene.has_volume() ? SceneData(volume(scene).data) : mesh(scene).data.data();
    close_colormap(scene, data.range(scene));
    return scene;
}

void DataStore::clear() {
    volumes_.clear();
    meshes_.clear();
}

}  // namespace lamina::study
