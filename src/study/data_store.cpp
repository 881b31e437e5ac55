// SPDX-License-Identifier: Apache-2.0
#include "study/data_store.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <glm/vec3.hpp>

#include "base/content_hash.h"
#include "base/enum_words.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/profile.h"
#include "choice/choose.h"
#include "image/npy.h"
#include "mesh_files/mesh_file.h"
#include "scene/clip.h"
#include "scene/given_transfer.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"
#include "study/report_files.h"
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

// Returns the mesh of this id, or nothing if the folder lacks it or its files are damaged.
std::optional<MadeMesh> find_mesh(const std::filesystem::path& folder, const std::string& id,
                                  const Scene& scene) {
    const std::filesystem::path facts_file = folder / (id + ".json");
    if (!std::filesystem::exists(facts_file)) return std::nullopt;
    try {
        const nlohmann::json facts = load_json(facts_file);
        Scene whole = scene;
        whole.scalar.clear();  // the file has one array only
        MadeMesh made{SceneData(whole, read_mesh(folder / (id + ".vtu")), report_from(facts)),
                      facts.at("ms").get<double>()};
        if (content_of(*made.data.mesh(whole)) != facts.at("mesh").get<std::string>())
            return std::nullopt;
        return made;
    } catch (const Error&) {
    } catch (const nlohmann::json::exception&) {
    }
    return std::nullopt;
}

// Keeps a mesh as ID.vtu and ID.json. The .vtu is written first, so a mesh with a .json is
// complete.
void keep_mesh(const std::filesystem::path& folder, const std::string& id, MadeMesh& made) {
    const SceneMesh& drawn = *made.data.mesh({});
    const TetMesh& tets = drawn.mesh;
    MeshData data;
    data.points.assign(tets.points().begin(), tets.points().end());
    data.tets.assign(tets.tets().begin(), tets.tets().end());
    data.point_scalars = {drawn.scalar};
    AtomicFile mesh(folder / (id + ".vtu"));
    write_vtu(mesh, data);
    mesh.commit();
    write_text(folder / (id + ".json"), json_text(facts_of(drawn, made.ms)) + "\n");
}

constexpr double units = 255;  // of errors: 1/255 of full scale

std::string key_of(const Scene& scene, TraceOf of, DataStore& data) {
    ContentHash hash;
    hash.add(picture_key(scene));
    if (of == TraceOf::volume) {
        hash.add(data.volume(scene).content);
        hash.add(scene.trace_tolerance);
    } else {
        hash.add(data.mesh(scene).content);
    }
    return hash.hex();
}

Reference traced(const Scene& scene, TraceOf of, DataStore& data) {
    const Stopwatch watch;
    const auto made = [&](auto result) {
        return Reference{
            {}, of, units * result.error_estimate, watch.milliseconds(), std::move(result.image)};
    };
    if (of == TraceOf::mesh) return made(data.mesh(scene).data.trace(scene));
    SceneData volume(data.volume(scene).data);
    return made(trace_picture(as_trace(scene, TraceOf::volume), volume));
}

std::string content_of(const PreciseImage& image) {
    ContentHash hash;
    hash.add(static_cast<double>(image.width));
    hash.add(image.rgba.data(), image.rgba.size() * sizeof(image.rgba[0]));
    return hash.hex();
}

// Loads ID.json: returns the facts of the reference, and the hash of its picture.
std::pair<Reference, std::string> load_facts(const std::filesystem::path& folder,
                                             const std::string& id) {
    const std::filesystem::path file = folder / (id + ".json");
    const nlohmann::json document = load_json(file);
    JsonReader reader(document, file);
    Reference reference;
    reference.id = id;
    reference.of = reader.choice<TraceOf>("of", enum_words<TraceOf>());
    reference.error_estimate = reader.number("error_estimate");
    reference.ms = reader.number("ms");
    return {std::move(reference), reader.text("picture")};
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
    if (const Lighting* const given = given_lighting(scene.lighting)) add(hash, *given);
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
    if (grid.lookup == VolumeLookup::nearest) hash.add("nearest");
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

// Returns a name of the mesh. It includes the transfer function: a mesh made from a volume stays
// coarse where it shows nothing.
std::string mesh_name(const Scene& scene) {
    if (const MeshFile* const file = scene.mesh_file()) {
        std::string name = file->path.string();
        if (file->time != 0) name += fmt::format(" {}", file->time);
        if (file->join > 0) name += fmt::format(" join {}", file->join);
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
    if (kept_.empty() || scene.mesh_file() != nullptr) return make();
    // A file of the same name may have other contents in a later process, so the hash of the
    // contents is part of the id.
    ContentHash id;
    id.add(volume(scene).content);
    id.add(mesh_name(scene));
    if (std::optional<MadeMesh> found = find_mesh(kept_, id.hex(), scene)) return std::move(*found);
    MadeMesh made = make();
    keep_mesh(kept_, id.hex(), made);
    return made;
}

// Returns the data that the scene draws. If something is automatic, it is chosen for the volume,
// also when a mesh is made from it.
SceneData DataStore::data_of(const Scene& scene) {
    if (!scene.draws_mesh()) return SceneData(volume(scene).data);
    const SceneData& data = mesh(scene).data.data();
    if (scene.mesh_file() != nullptr || !leaves_something_open(scene)) return data;
    return SceneData(volume(scene).data, SceneData(data).mesh(scene));
}

Scene DataStore::closed(Scene scene) {
    if (scene.draws_mesh() && !has_open_colormap(scene)) return scene;
    SceneData data = scene.has_volume() ? SceneData(volume(scene).data) : mesh(scene).data.data();
    data.close_transfer_function(scene);
    return scene;
}

void DataStore::clear() {
    volumes_.clear();
    meshes_.clear();
}

Reference ReferenceStore::load(const std::filesystem::path& folder, const std::string& id) {
    auto [reference, content] = load_facts(folder, id);
    const std::filesystem::path file = folder / (id + ".npy");
    reference.image = read_npy(file);
    const std::string found = content_of(reference.image);
    if (found != content) {
        fail("{}: found a picture of hash {}, expected {} as {}.json says", file.string(), found,
             content, id);
    }
    return std::move(reference);
}

double ReferenceStore::error_estimate(const std::filesystem::path& folder, const std::string& id) {
    return load_facts(folder, id).first.error_estimate;
}

// Returns the kept reference, or nothing if it cannot be read, which is reported once.
std::optional<Reference> ReferenceStore::find(const std::string& id) {
    if (lost_.contains(id)) return std::nullopt;
    try {
        return load(folder_, id);
    } catch (const Error& error) {
        say_(fmt::format("{}: the reference is traced again", error.what()));
        lost_.insert(id);
        return std::nullopt;
    }
}

bool ReferenceStore::is_kept(const std::string& id) {
    return find(id).has_value();
}

Reference ReferenceStore::make(const std::string& id, const Scene& scene, TraceOf of,
                               DataStore& data) const {
    std::optional<AtomicFile> picture;  // opened first: an unwritable folder fails at once
    if (!folder_.empty()) picture.emplace(folder_ / (id + ".npy"));
    Reference reference = traced(scene, of, data);
    reference.id = id;
    if (!picture) return reference;
    // The picture is written before the facts, so that a reference with a .json is complete.
    write_npy(*picture, reference.image);
    picture->commit();
    const nlohmann::ordered_json facts{{"of", name_of(reference.of)},
                                       {"error_estimate", reference.error_estimate},
                                       {"ms", reference.ms},
                                       {"picture", content_of(reference.image)}};
    write_text(folder_ / (id + ".json"), json_text(facts) + "\n");
    return reference;
}

const Reference& ReferenceStore::get(const Scene& scene, TraceOf of, DataStore& data) {
    const std::string id = key_of(scene, of, data);
    const auto known = references_.find(id);
    if (known != references_.end()) return known->second;
    std::optional<Reference> reference;
    if (!folder_.empty() && std::filesystem::exists(folder_ / (id + ".json"))) reference = find(id);
    if (!reference) reference = make(id, scene, of, data);
    return references_.emplace(id, std::move(*reference)).first->second;
}

}  // namespace lamina::study
