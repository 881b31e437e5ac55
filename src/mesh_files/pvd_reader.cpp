// SPDX-License-Identifier: Apache-2.0
// "ParaView/Data formats", "PVD File Format": <DataSet timestep="T" group="" part="N" file="F"/>.
#include "mesh_files/pvd_reader.h"

#include <cmath>
#include <map>
#include <string>

#include "base/error.h"
#include "mesh_files/mesh_assembly.h"
#include "mesh_files/pvtu_reader.h"
#include "mesh_files/text_reader.h"
#include "mesh_files/vtk_index.h"
#include "mesh_files/vtu_reader.h"

namespace lamina {
namespace {

double time_of(pugi::xml_node set, const std::string& what) {
    const pugi::xml_attribute attribute = set.attribute("timestep");
    if (!attribute) return 0;
    TextReader reader(attribute.value());
    double time = 0;
    if (!reader.read(time) || !reader.at_end() || !std::isfinite(time)) {
        fail("{}: timestep: found {}, expected a number", what,
             next_word(TextReader(attribute.value())));
    }
    return time;
}

}  // namespace

std::vector<PvdStep> steps_of_pvd(const std::filesystem::path& path) {
    const VtkIndex index(path, "Collection");
    std::map<double, std::vector<std::filesystem::path>> by_time;
    std::size_t number = 0;
    for (const pugi::xml_node set : index.node().children("DataSet")) {
        const std::string which = fmt::format("DataSet {}", ++number);
        by_time[time_of(set, index.name() + ": " + which)].push_back(
            index.file_in(set, "file", which));
    }
    if (by_time.empty()) fail("{}: no <DataSet> in it", index.name());
    std::vector<PvdStep> steps;
    for (auto& [time, files] : by_time) {
        expect_each_once(files, fmt::format("{}: timestep {}", index.name(), time));
        steps.push_back({time, std::move(files)});
    }
    return steps;
}

MeshData read_pvd(const std::filesystem::path& path, std::int64_t step) {
    const std::vector<PvdStep> steps = steps_of_pvd(path);
    if (step < 0 || step >= std::ssize(steps)) {
        fail("{}: time: found {}, expected 0 to {}, the steps of the file", path.string(), step,
             std::ssize(steps) - 1);
    }
    const PvdStep& chosen = steps[static_cast<std::size_t>(step)];
    MeshAssembly assembly(fmt::format("{}: step {} (time {})", path.string(), step, chosen.time));
    for (const std::filesystem::path& file : chosen.files) {
        if (file.extension() == ".pvtu") {
            add_pvtu(file, assembly);
        } else {
            add_vtu(file, assembly);
        }
    }
    return assembly.finish();
}

}  // namespace lamina
