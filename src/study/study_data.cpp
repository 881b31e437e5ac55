// SPDX-License-Identifier: Apache-2.0
#include "study/study_data.h"

#include <algorithm>
#include <exception>
#include <map>
#include <utility>

#include "base/error.h"
#include "scene/given_transfer.h"
#include "study/picture_key.h"

namespace lamina::study {
namespace {

using Kind = StudyData::Kind;

std::string content_of(const StudyData& data, DataStore& store) {
    try {
        if (data.kind == Kind::volume) return store.volume(data.drawn).content;
        if (data.kind == Kind::mesh) return store.mesh(data.drawn).content;
        return study::content_of(read_paraview_colormap(colormap_file_of(data.drawn)));
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace

void add_data(std::size_t number, const Scene& drawn, TraceOf reference,
              std::vector<StudyData>& data) {
    const auto add = [&](Kind kind, const std::string& name) {
        StudyData found{kind, name, number, drawn};
        if (std::find(data.begin(), data.end(), found) == data.end())
            data.push_back(std::move(found));
    };
    const bool needs_mesh = drawn.draws_mesh() || reference == TraceOf::mesh;
    const bool needs_volume = !drawn.draws_mesh() || reference == TraceOf::volume ||
                              (needs_mesh && drawn.made_mesh() != nullptr);
    if (needs_volume && drawn.has_volume()) add(Kind::volume, volume_name(drawn));
    if (needs_mesh && drawn.mesh_file() != nullptr) add(Kind::mesh, mesh_name(drawn));
    const std::filesystem::path colormap = colormap_file_of(drawn);
    if (!colormap.empty()) add(Kind::colormap, colormap.string());
}

std::vector<std::string> contents_of(const std::vector<StudyData>& data, DataStore& store) {
    std::map<std::pair<Kind, std::string>, std::string> known;
    std::vector<std::string> contents;
    for (const StudyData& each : data) {
        if (each.scene != data.front().scene) store.clear();  // memory is for one scene at a time
        const auto [found, added] = known.try_emplace({each.kind, each.name});
        if (added) found->second = content_of(each, store);
        contents.push_back(found->second);
    }
    if (!data.empty() && data.back().scene != data.front().scene) store.clear();
    return contents;
}

}  // namespace lamina::study
