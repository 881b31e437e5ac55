// SPDX-License-Identifier: Apache-2.0
#include "render/scene_data.h"

#include "base/error.h"
#include "base/profile.h"
#include "mesh/tet_mesh.h"
#include "scene/given_transfer.h"
#include "volume/labels.h"

namespace lamina {
namespace {

std::map<std::string, std::int64_t> counts_of(const SceneMesh& mesh) {
    const MeshFindings& findings = mesh.mesh.findings();
    const CellCounts& cells = findings.cells;
    std::map<std::string, std::int64_t> counts;
    counts["tets"] = static_cast<std::int64_t>(mesh.mesh.tets().size());
    counts["degenerate_tets"] = findings.degenerate;
    counts["inverted_tets"] = findings.inverted;
    counts["duplicate_tets"] = findings.duplicates;
    counts["nonmanifold_faces"] = findings.nonmanifold_faces;
    counts["folded_faces"] = findings.folded_faces;
    counts["non_finite_values"] = measure_range(mesh.scalar.values).non_finite;
    counts["split_cells"] = cells.split;
    counts["skipped_cells"] = cells.skipped;
    counts["straightened_cells"] = cells.straightened;
    counts["turned_over_tets"] = cells.turned_over;
    counts["not_star_shaped_cells"] = cells.not_star_shaped;
    counts["made_points"] = cells.made_points;
    counts["ghost_cells"] = cells.ghosts;
    counts["merged_points"] = cells.merged_points;
    counts["copied_points"] = findings.copies;
    if (mesh.averaged) counts["averaged_arrays"] = 1;
    return counts;
}

}  // namespace

SceneData::SceneData(Volume volume)
    : SceneData(std::make_shared<const VolumeData>(std::move(volume))) {}

SceneData::SceneData(const Scene& scene, MeshData mesh, const std::optional<MeshReport>& report) {
    auto drawn = std::make_shared<SceneMesh>(scene_mesh(scene, std::move(mesh)));
    drawn->report = report;
    mesh_ = std::move(drawn);
    mesh_given_ = true;
}

const std::shared_ptr<const VolumeData>& SceneData::volume(const Scene& scene) {
    if (volume_) return volume_;
    volume_ = keep_warnings(volume_warnings_, [&] {
        Stage loading("load");
        Volume volume = open_volume(scene);
        volume_ms_["load"] = loading.end();
        Stage measuring("measure");
        Stage measuring_bricks("bricks");
        auto measured = std::make_shared<const VolumeData>(std::move(volume));
        measuring_bricks.end();
        volume_ms_["measure"] = measuring.end();
        return measured;
    });
    return volume_;
}

const std::shared_ptr<const SceneMesh>& SceneData::mesh(const Scene& scene) {
    if (mesh_) return mesh_;
    const bool from_kept = makes_mesh(scene) && (volume_ || keeps_volume_);
    if (from_kept) volume(scene);
    Stage loading("load");
    mesh_ = std::make_shared<const SceneMesh>(keep_warnings(mesh_warnings_, [&] {
        return from_kept ? scene_mesh(scene, volume_->volume) : load_mesh(scene);
    }));
    mesh_ms_["load"] = loading.end();
    if (!volume_given_ && !keeps_volume_) volume_.reset();
    return mesh_;
}

const FaceTree& SceneData::open_faces(const Scene& scene) {
    if (open_faces_) return *open_faces_;
    const TetMesh& tets = mesh(scene)->mesh;
    Stage building("boundary_tree");
    open_faces_ = std::make_shared<const FaceTree>(tets, tets.open_faces());
    mesh_ms_["boundary_tree"] = building.end();
    return *open_faces_;
}

std::unique_ptr<Field> SceneData::field(const Scene& scene) {
    if (scene.draws_mesh()) return std::make_unique<MeshField>(*mesh(scene));
    return std::make_unique<VolumeField>(*volume(scene));
}

const ValueRange& SceneData::range(const Scene& scene) {
    if (range_) return *range_;
    if (volume_given_ || (!mesh_given_ && scene.has_volume())) {
        const bool needed = volume_ != nullptr || !scene.draws_mesh() || makes_mesh(scene);
        range_ = volume(scene)->bricks.whole;
        if (!needed) volume_.reset();
    } else {
        range_ = measure_range(mesh(scene)->scalar.values).range;
    }
    return *range_;
}

void SceneData::close_transfer_function(Scene& scene) {
    const bool open = has_open_colormap(scene);
    if (open) close_colormap(scene, range(scene));
    if (scene.transfer_function.is_automatic() || scene.draws_mesh()) return;
    const TransferFunction& given = *scene.transfer_function;
    // The range of the data is one of codes.
    try {
        scene.transfer_function =
            open ? marked(scene, given) : over_codes(given, volume(scene)->volume);
    } catch (const GivenTransferError& error) {
        fail("{}: transfer_function.{}: {}", scene.file.string(), error.key, error.what());
    }
}

TransferFunction SceneData::marked(const Scene& scene, const TransferFunction& drawn) {
    if (scene.draws_mesh()) return drawn;
    const std::string identity = identity_of_codes(volume(scene)->volume);
    return identity.empty() ? drawn : drawn.with_codes(identity);
}

void SceneData::forget_mesh() {
    if (mesh_given_) return;
    mesh_.reset();
    range_.reset();
    open_faces_.reset();
    mesh_counts_.reset();
    mesh_ms_.clear();
    mesh_warnings_.clear();
}

Warnings SceneData::warnings(const Scene& scene) const {
    Warnings said;
    if (!scene.draws_mesh() || makes_mesh(scene)) said = volume_warnings_;
    if (scene.draws_mesh()) said.insert(said.end(), mesh_warnings_.begin(), mesh_warnings_.end());
    return said;
}

void SceneData::add_to(const Scene& scene, FrameStatistics& statistics) {
    for (const Stages& stages : {volume_ms_, mesh_ms_})
        for (const auto& [stage, ms] : stages) statistics.stages_ms[stage] += ms;
    if (!scene.draws_mesh()) {
        if (volume_) statistics.counts["non_finite_samples"] = volume_->bricks.non_finite;
        return;
    }
    if (!mesh_) return;
    if (!mesh_counts_) mesh_counts_ = counts_of(*mesh_);
    for (const auto& [name, count] : *mesh_counts_) statistics.counts[name] = count;
    if (mesh_->report) statistics.mesh_error = mesh_->report->relative_error();
}

}  // namespace lamina
