// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace lamina {

// Settings for a mesh that is made from a volume (scene file: "mesh").
struct MeshSettings {
    double tolerance = 0.02;  // largest error, as a share of the volume's range of values; > 0
    std::int64_t max_tets = 5000000;
    // If true, every sample of the volume becomes a point, and every cell six tets (the Kuhn
    // split). Otherwise the mesh has as few tets as the tolerance allows.
    bool kuhn = false;

    friend bool operator==(const MeshSettings&, const MeshSettings&) = default;
};

// Describes the mesh that was made.
struct MeshReport {
    std::int64_t points = 0;
    std::int64_t tets = 0;
    std::int64_t kuhn_tets = 0;  // the Kuhn split has so many, or would have
    int rounds = 0;              // rounds of refinement of the adaptive mesh
    double range = 0;            // largest minus least value of the volume
    // Largest difference between the mesh and the volume's trilinear field, anywhere, in the data's
    // units.
    double error = 0;
    bool within_tolerance = false;
    bool stopped_by_max_tets = false;

    double relative_error() const { return range > 0 ? error / range : 0; }
};

}  // namespace lamina
