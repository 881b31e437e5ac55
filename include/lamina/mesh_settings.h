// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// How a mesh is made from a volume (scene file: "mesh").
struct MeshSettings {
    double tolerance = 0.02;  // of the volume's range of values, > 0
    std::int64_t max_tets = 5000000;
    bool kuhn = false;  // every sample, six tets a cell, instead of as few as the tolerance allows
};

// What came out.
struct MeshReport {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::int64_t kuhn_tets = 0;  // that the Kuhn split has, or would have
    int rounds = 0;              // of the adaptive mesh
    double range = 0;            // of the volume's values: largest - least
    double error = 0;  // in the data's units: nowhere is the mesh farther from the trilinear field
    bool within_tolerance = false;
    bool stopped_by_max_tets = false;

    double relative_error() const { return range > 0 ? error / range : 0; }
};

}  // namespace lamina
