// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace lamina::study {

// Predicts how long the meshes of a ladder take to be made, drawn and traced, which is nearly all
// of a cross-check's time. The time grows with the tets, and these with a power of 1 / tolerance.
class LadderCost {
  public:
    // A mesh has `most_tets` at most. `ends_there`: the ladder ends with a mesh that has so many.
    LadderCost(std::int64_t most_tets, bool ends_there)
        : most_tets_(static_cast<double>(most_tets)), ends_there_(ends_there) {}

    // Takes a mesh that is done. Tolerances decrease.
    void add(double tolerance, std::int64_t tets, double seconds);

    // Seconds at most for so many meshes of which nothing is known, on one processor.
    double at_most(std::size_t meshes) const;
    // Seconds for meshes of these tolerances, which decrease. A mesh must have been added.
    double of(std::span<const double> tolerances) const;

  private:
    struct Made {
        double tolerance, tets;
    };

    double most_tets_;
    bool ends_there_;
    double power_ = 0, seconds_a_tet_ = 0;  // of the last mesh
    std::optional<Made> last_;
};

}  // namespace lamina::study
