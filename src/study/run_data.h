// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "study/data_store.h"
#include "study/run_list.h"

namespace lamina::study {

// A volume, a mesh or a colour map that runs of a study draw.
struct StudyData {
    enum class Kind { volume, mesh, colormap };
    Kind kind;
    std::string name;   // its path, or its formula
    std::size_t scene;  // number of the scene in the study
    Scene drawn;        // scene of a run that draws it

    bool operator==(
        const StudyData& other) const {  // whether both are the same data of the same scene
        return kind == other.kind && scene == other.scene && name == other.name;
    }
};

// Adds the data that a run of the study's scene `number` draws, if they are not listed yet. The
// data of its reference are included. For a mesh made from a volume the volume is added.
void add_data(std::size_t number, const Scene& drawn, TraceOf reference,
              std::vector<StudyData>& data);

// Returns hashes of the contents of data. A hash is empty if the data cannot be read; the runs that
// need them report this. Each is read once. Data of a single scene stay in the store.
std::vector<std::string> contents_of(const std::vector<StudyData>& data, DataStore& store);

// Returns the scene of a run. Throws KeyError for settings that no run can measure: the method
// "trace", or a reference that the scene does not have.
Scene scene_of(const StudyRun& run, const StudyFile& file);
TraceOf reference_of(const Scene& scene, const StudyFile& file);

// Reads every run's scene and checks that its files exist. Throws Error if a file is missing, a
// key is unknown, or no run of a scene can be drawn. Other errors of single runs are found when
// these are run. Returns the data that the runs draw, each once.
std::vector<StudyData> check_runs(const RunList& list, const StudyFile& file);

// Adds the data to the list, with the hashes of their contents (contents_of()).
void list_data(const std::vector<StudyData>& data, DataStore& store, RunList& list);

}  // namespace lamina::study
