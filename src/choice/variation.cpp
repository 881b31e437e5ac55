// SPDX-License-Identifier: Apache-2.0
#include "choice/variation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>

#include "base/parallel.h"
#include "choice/constant_border.h"
#include "choice/field.h"
#include "mesh/tet_mesh.h"
#include "volume/sample_source.h"

namespace lamina {

namespace {

// Share of all places that a mean around a bin should have, and the largest distance of its bins.
constexpr double enough = 1e-4;
constexpr std::size_t nearest_bins = 3, farthest_bins = 8;

}  // namespace

Variation::Variation(double lo, double hi, std::size_t bins)
    : lo_(lo), hi_(hi), weight_(bins), slope_(bins), coherent_(bins) {}

void Variation::add(double value, double weight, double slope, bool coherent) {
    const std::size_t bin = bin_of(value);
    weight_[bin] += weight;
    slope_[bin] += weight * slope;
    slope_squares_ += weight * slope * slope;
    if (coherent) coherent_[bin] += weight;
}

void Variation::add(const Variation& other) {
    for (std::size_t i = 0; i < bins(); ++i) {
        weight_[i] += other.weight_[i];
        slope_[i] += other.slope_[i];
        coherent_[i] += other.coherent_[i];
    }
    slope_squares_ += other.slope_squares_;
}

bool Variation::empty() const {
    return std::ranges::all_of(weight_, [](double weight) { return weight == 0; });
}

double Variation::value(std::size_t bin) const {
    const double place = (static_cast<double>(bin) + .5) / static_cast<double>(bins());
    return lo_ * (1 - place) + hi_ * place;
}

std::size_t Variation::bin_of(double value) const {
    const double place = (value / 2 - lo_ / 2) / (hi_ / 2 - lo_ / 2) * static_cast<double>(bins());
    if (!(place > 0)) return 0;
    return static_cast<std::size_t>(std::min(place, static_cast<double>(bins() - 1)));
}

double Variation::mean(const std::vector<double>& sums, std::size_t bin) const {
    double all = 0;
    for (const double one : weight_) all += one;
    double sum = 0, weight = 0;
    for (std::size_t width = nearest_bins; width <= farthest_bins; ++width) {
        const std::size_t first = bin > width ? bin - width : 0;
        const std::size_t end = std::min(bin + width + 1, bins());
        sum = weight = 0;
        for (std::size_t i = first; i < end; ++i) {
            sum += sums[i];
            weight += weight_[i];
        }
        if (weight > enough * all) break;
    }
    return weight > 0 ? sum / weight : 0;
}

double Variation::slope(std::size_t bin) const {
    return mean(slope_, bin);
}

double Variation::coherence(std::size_t bin) const {
    return mean(coherent_, bin);
}

// The square of the mean over the mean of the squares.
double Variation::evenness() const {
    double all = 0, slopes = 0;
    for (std::size_t bin = 0; bin < bins(); ++bin) {
        all += weight_[bin];
        slopes += slope_[bin];
    }
    return slope_squares_ > 0 ? slopes * slopes / (all * slope_squares_) : 0;
}

Variation Variation::negated() const {
    Variation result(-hi_, -lo_, bins());
    result.slope_squares_ = slope_squares_;
    std::ranges::reverse_copy(weight_, result.weight_.begin());
    std::ranges::reverse_copy(slope_, result.slope_.begin());
    std::ranges::reverse_copy(coherent_, result.coherent_.begin());
    return result;
}

namespace {

// Pieces of an axis in which places are taken: `edge` samples each, at most `most` of them, spread
// evenly. Samples at the ends of an axis, which lack a neighbour, are left out if it has others.
struct AxisPieces {
    std::int64_t first, inner, edge, count;

    AxisPieces(std::int64_t begin, std::int64_t size, std::int64_t edge_wanted, std::int64_t most)
        : first(begin + (size > 2 ? 1 : 0)),
          inner(size > 2 ? size - 2 : size),
          edge(std::min(edge_wanted, inner)),
          count(std::min(most, (inner + edge - 1) / edge)) {}

    std::int64_t begin(std::int64_t piece) const {
        const std::int64_t steps = std::max<std::int64_t>(count - 1, 1);
        return first + (inner - edge) * piece / steps;
    }
};

// The places of a volume, in blocks. A large volume has fewer, larger ones: each is read at once
// if the volume stays in its files.
class VolumePlaces {
  public:
    VolumePlaces(const Volume& volume, const SampleBox& inside, const ValueRange& measured,
                 const Variation& bins)
        : volume_(volume), inside_(inside), measured_(measured), bins_(bins) {
        const bool large = volume.grid().sample_count() > large_volume;
        const std::int64_t along = large ? 8 : 4, most = large ? 8 : 16;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pieces_.emplace_back(inside.first[axis], inside.size[axis], along, most);
            inverse_step_[axis] = 1 / glm::length(volume.grid().step[axis]);
        }
    }

    // Layers of blocks are counted at once, but added in their order, so that sums are the same
    // with any number of threads.
    Variation count() const {
        std::vector<Variation> layers(static_cast<std::size_t>(pieces_[2].count), bins_);
        parallel_for(pieces_[2].count, 1, [&](std::int64_t z) {
            for (std::int64_t y = 0; y < pieces_[1].count; ++y) {
                for (std::int64_t x = 0; x < pieces_[0].count; ++x)
                    count_block({x, y, z}, layers[static_cast<std::size_t>(z)]);
            }
        });
        Variation total = bins_;
        for (const Variation& layer : layers) total.add(layer);
        return total;
    }

  private:
    void count_block(const std::array<std::int64_t, 3>& piece, Variation& into) const {
        SampleBox block, around;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t begin = inside_.first[axis], end = begin + inside_.size[axis];
            block.first[axis] = pieces_[axis].begin(piece[axis]);
            block.size[axis] = pieces_[axis].edge;
            around.first[axis] = std::max(block.first[axis] - 1, begin);
            around.size[axis] =
                std::min(block.first[axis] + block.size[axis] + 1, end) - around.first[axis];
        }
        with_sample_type(volume_.type(), [&](auto zero) {
            using T = decltype(zero);
            visit_window<T>(volume_, around, [&](const SampleWindow<T>& window) {
                count_window(window, block, into);
            });
        });
    }

    template <typename T>
    void count_window(const SampleWindow<T>& window, const SampleBox& block,
                      Variation& into) const {
        for (std::int64_t z = block.first[2]; z < block.first[2] + block.size[2]; ++z) {
            for (std::int64_t y = block.first[1]; y < block.first[1] + block.size[1]; ++y) {
                for (std::int64_t x = block.first[0]; x < block.first[0] + block.size[0]; ++x)
                    count_place(window, {x, y, z}, into);
            }
        }
    }

    // A place is coherent if half the difference of its neighbours is larger, over all axes, than
    // the second difference: for white noise of variance s^2 their squares are s^2/2 and 6 s^2.
    template <typename T>
    void count_place(const SampleWindow<T>& window, const std::array<std::int64_t, 3>& at,
                     Variation& into) const {
        const auto value = [&](std::size_t axis, std::int64_t step) {
            std::array<std::int64_t, 3> there = at;
            there[axis] += step;
            return static_cast<double>(window.at(there[0], there[1], there[2]));
        };
        const double middle = value(0, 0);
        if (!is_measured(middle)) return;
        double slope = 0, first = 0, second = 0, axes = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (inside_.size[axis] < 3) continue;
            const double before = value(axis, -1), after = value(axis, 1);
            if (!is_measured(before) || !is_measured(after)) return;
            const double half = after / 2 - before / 2;
            const double bend = (after - middle) - (middle - before);
            slope += half * inverse_step_[axis] * half * inverse_step_[axis];
            first += half * half;
            second += bend * bend;
            ++axes;
        }
        into.add(middle, 1, std::sqrt(slope), first > 0 && first * axes > second);
    }

    bool is_measured(double value) const { return value >= measured_.lo && value <= measured_.hi; }

    const Volume& volume_;
    const SampleBox inside_;
    const ValueRange measured_;
    const Variation& bins_;
    std::vector<AxisPieces> pieces_;
    std::array<double, 3> inverse_step_{};
};

constexpr std::size_t measured_tets = std::size_t{1} << 17;  // more tets are sampled evenly

}  // namespace

Variation variation_of(const Volume& volume, const SampleBox& inside, const ValueRange& measured,
                       const Variation& bins) {
    return VolumePlaces(volume, inside, measured, bins).count();
}

// The gradient g of a tet fulfils dot(g, e_i) = d_i for its edges e_i from corner 0, along which
// the values differ by d_i.
Variation variation_of(const SceneMesh& mesh, const ValueRange& measured, const Variation& bins) {
    Variation total = bins;
    const auto points = mesh.mesh.points();
    const auto tets = mesh.mesh.tets();
    const std::size_t step = tets.size() / measured_tets + 1;
    for (std::size_t i = 0; i < tets.size(); i += step) {
        std::array<glm::dvec3, 4> at;
        std::array<double, 4> values;
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k) {
            at[k] = points[static_cast<std::size_t>(tets[i][k])];
            values[k] = mesh.scalar.values[static_cast<std::size_t>(tets[i][k])];
            inside = inside && values[k] >= measured.lo && values[k] <= measured.hi;
        }
        if (!inside) continue;
        const glm::dvec3 a = at[1] - at[0], b = at[2] - at[0], c = at[3] - at[0];
        const double volume = glm::dot(a, glm::cross(b, c));
        const glm::dvec3 gradient = ((values[1] - values[0]) * glm::cross(b, c) +
                                     (values[2] - values[0]) * glm::cross(c, a) +
                                     (values[3] - values[0]) * glm::cross(a, b)) /
                                    volume;
        const double slope = glm::length(gradient);
        if (!std::isfinite(slope)) continue;
        // A fifth of the tet counts for each corner, moved half the way to the mean, and for it.
        const double mean = (values[0] + values[1] + values[2] + values[3]) / 4;
        for (const double value : {values[0], values[1], values[2], values[3], mean})
            total.add((value + mean) / 2, std::abs(volume) / 5, slope, slope > 0);
    }
    return total;
}

}  // namespace lamina
