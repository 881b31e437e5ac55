// SPDX-License-Identifier: Apache-2.0
#include "papers/kraus_stage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <utility>

#include "papers/grid_mesh.h"

namespace lamina::papers {
namespace {

constexpr double graded_ratio = 1e4, bump = 0.25;
const std::vector<std::string> data_sets{"bluntfin", "combustor", "torso"};

std::filesystem::path file_of(const std::filesystem::path& data, const std::string& name) {
    return data / (name + ".vtu");
}

}  // namespace

KrausStage::KrausStage(const Capabilities& capabilities, KrausSizes sizes,
                       std::filesystem::path data)
    : capabilities_(capabilities), sizes_(std::move(sizes)), data_(std::move(data)) {}

std::filesystem::path KrausStage::data_folder() {
    const char* const data = std::getenv("LAMINA_DATA");
    return data == nullptr ? std::filesystem::path() : std::filesystem::path(data);
}

bool KrausStage::has(const std::string& data_set) const {
    return !data_.empty() && std::filesystem::exists(file_of(data_, data_set));
}

KrausSubject KrausStage::make(const std::string& name) const {
    const auto subject = [&](study::TracedMesh mesh, bool measured_data) {
        return make_kraus_subject(std::move(mesh), kraus_view(name), measured_data, sizes_.width,
                                  sizes_.height);
    };
    if (name == "graded" || name == "plate") {
        return subject(
            study::TracedMesh(make_graded_mesh(sizes_.graded_cells, sizes_.graded_layers,
                                               graded_ratio, name == "graded" ? bump : 0)),
            false);
    }
    if (name == "box") {
        return subject(study::TracedMesh(
                           make_box_mesh({sizes_.box_cells, sizes_.box_cells, sizes_.box_cells})),
                       false);
    }
    Scene scene;
    scene.mesh = MeshFile{file_of(data_, name)};
    SceneData data;
    data.mesh(scene);
    return subject(study::TracedMesh(std::move(data)), true);
}

KrausSubject& KrausStage::subject(const std::string& name) {
    const bool generated = name == "graded" || name == "plate";
    const std::string there = generated || has(name) ? name : "box";
    auto& subject = subjects_[there];
    if (!subject) {
        subject = std::make_unique<KrausSubject>(make(there));
        subject->tables = tables_;
    }
    return *subject;
}

std::vector<KrausSubject*> KrausStage::subjects() {
    std::vector<KrausSubject*> found;
    for (const std::string& name : data_sets) {
        if (has(name)) found.push_back(&subject(name));
    }
    if (found.empty()) found.push_back(&subject("box"));
    for (const char* name : {"graded", "plate"}) found.push_back(&subject(name));
    return found;
}

nlohmann::ordered_json result_with_data(Findings findings, nlohmann::ordered_json values,
                                        nlohmann::ordered_json printed, const std::string& more,
                                        const KrausStage& stage, const DataNeeds& needs) {
    std::vector<std::string> missing;
    for (const std::string& name : needs.data_sets) {
        if (!stage.has(name)) missing.push_back(name + ".vtu");
    }
    if (!missing.empty()) findings.make_untestable();
    auto result = findings.result(std::move(values), std::move(printed), more);
    if (missing.empty()) return result;
    for (const char* const key : {"remark", "note"}) {
        result[key] =
            fmt::format("Set LAMINA_DATA to a folder that holds {}; {}. {}",
                        fmt::join(missing, ", "), needs.instead, result[key].get<std::string>());
    }
    return result;
}

}  // namespace lamina::papers
