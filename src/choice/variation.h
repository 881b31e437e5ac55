// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "lamina/volume.h"
#include "scene/scene.h"
#include "volume/min_max_bricks.h"
#include "volume/sample_source.h"

namespace lamina {

// How a field varies around its values, counted by value in equal bins. From this follows what is
// noise and what is the surface of something: around noise, values change their direction from
// sample to sample; on a surface they go on rising.
class Variation {
  public:
    // `bins`: 1 or more. Values outside of lo..hi count for the outermost bins.
    Variation(double lo, double hi, std::size_t bins);

    // Counts places with this value. `slope`: length of the gradient per world unit. `coherent`:
    // the field goes on rising across the place.
    void add(double value, double weight, double slope, bool coherent);
    void add(const Variation& other);  // one with the same bins

    std::size_t bins() const { return weight_.size(); }
    double lo() const { return lo_; }
    double hi() const { return hi_; }
    bool empty() const;
    double value(std::size_t bin) const;  // in the middle of the bin
    std::size_t bin_of(double value) const;

    // Return the mean length of gradients, and the share 0..1 of coherent places, around a bin:
    // over the nearest bins that hold enough; 0 if nothing was counted. White noise has a share
    // below .45.
    double slope(std::size_t bin) const;
    double coherence(std::size_t bin) const;
    double weight(std::size_t bin) const { return weight_[bin]; }
    // Returns 1 if all gradients have one length, as those of a distance have, and less the more
    // their lengths differ: .85 for a random smooth field; 0 if there is none.
    double evenness() const;

    // Returns the same of the field with all values negated.
    Variation negated() const;

  private:
    double mean(const std::vector<double>& sums, std::size_t bin) const;

    double lo_, hi_;
    std::vector<double> weight_, slope_, coherent_;  // sums
    double slope_squares_ = 0;                       // sum over all bins
};

// Measure the variation at up to 2^18 places all over the data, which do not depend on threads or
// on where the samples are kept. Places next to a value outside of `measured` are left out.
// `inside`: the samples that count.
Variation variation_of(const Volume& volume, const SampleBox& inside, const ValueRange& measured,
                       const Variation& bins);
// In a tet the gradient is constant, and all places are coherent.
Variation variation_of(const SceneMesh& mesh, const ValueRange& measured, const Variation& bins);

}  // namespace lamina
