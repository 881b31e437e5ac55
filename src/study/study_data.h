// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "study/data_store.h"

namespace lamina::study {

// A volume, a mesh or a colour map that runs of a study draw.
struct StudyData {
    enum class Kind { volume, mesh, colormap };
    Kind kind;
    std::string name;   // its path, or its formula
    std::size_t scene;  // of the study
    Scene drawn;        // a run's that draws it

    bool operator==(const StudyData& other) const {  // the same data of the same scene
        return kind == other.kind && scene == other.scene && name == other.name;
    }
};

// Adds what a run of the study's scene `number` draws, where it is not there yet: its reference is
// part of it, and a mesh made from a volume is that volume.
void add_data(std::size_t number, const Scene& drawn, TraceOf reference,
              std::vector<StudyData>& data);

// Names what each of them holds, wherever it comes from; empty where it cannot be read: runs that
// need it say so. Each is read once; those of a single scene stay in the store.
std::vector<std::string> contents_of(const std::vector<StudyData>& data, DataStore& store);

}  // namespace lamina::study
