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
    struct Step {
        double tolerance;
        std::int64_t most_tets;
        bool last_if_full = false;  // no such step comes after one that has most_tets
    };

    // Takes a mesh that is done. Tolerances decrease.
    void add(double tolerance, std::int64_t tets, double seconds);

    // Returns about how many seconds of one processor these meshes take if all are as large as they
    // may be. Tolerances decrease.
    static double most_seconds(std::span<const Step> steps);
    // Returns the seconds to expect after the meshes that were added, one at least.
    double expected_seconds(std::span<const Step> steps) const;

  private:
    struct Made {
        double tolerance, tets;
    };

    double power_ = 0, seconds_a_tet_ = 0;  // as the last meshes had them
    std::optional<Made> last_;
};

}  // namespace lamina::study
