// SPDX-License-Identifier: Apache-2.0
#include "optics/table_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "base/parallel.h"

namespace lamina {

namespace {

constexpr std::size_t most_points = 24;
constexpr int halvings_of_range = 11;  // the narrowest runs: 1 / 2048 of the scalars
constexpr int length_steps = 7;        // from shortest to longest, in equal ratios
constexpr int segment_counts[] = {1, 2, 8, 64, 1024};
// What lies behind this is not seen: far below the units that the error is counted in.
constexpr double least_transmittance = 1e-7;

// Splitmix64, as in NUMERICS section 2: the same numbers on every machine.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double next() {  // in [0, 1)
        state_ += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }

  private:
    std::uint64_t state_;
};

struct Run {
    double from, to;  // scalars
};

// Scalars around which runs are tried: the points of the transfer function, at most so many.
std::vector<double> points_inside(const TransferFunction& transfer_function, double lo, double hi) {
    std::vector<double> inside;
    for (const TransferKnot& knot : transfer_function.knots()) {
        const bool repeated = !inside.empty() && inside.back() == knot.value;
        if (knot.value > lo && knot.value < hi && !repeated) inside.push_back(knot.value);
    }
    if (inside.size() <= most_points) return inside;
    std::vector<double> some;
    for (std::size_t i = 0; i < most_points; ++i) {
        some.push_back(inside[i * inside.size() / most_points]);
    }
    return some;
}

std::vector<Run> make_runs(const TransferFunction& transfer_function, const TableRays& rays) {
    std::vector<Run> runs = {{rays.lo, rays.hi}, {rays.hi, rays.lo}};
    Random random(1);
    for (const double point : points_inside(transfer_function, rays.lo, rays.hi)) {
        for (int halving = 1; halving <= halvings_of_range; halving += 2) {
            // Not centred: the point may lie anywhere in the run, and in the table's cells.
            const double width = std::ldexp(rays.hi - rays.lo, -halving);
            const double before = width * random.next();
            const double from = std::max(rays.lo, point - before);
            const double to = std::min(rays.hi, point - before + width);
            runs.push_back({from, to});
            runs.push_back({to, from});
        }
    }
    return runs;
}

// Where a ray's segments end, in world units. Random ones are between a quarter and the double of
// `length` long, as far as shortest and longest allow.
std::vector<double> make_cuts(int count, double length, const TableRays& rays, bool equal,
                              Random& random) {
    const double least = std::max(rays.shortest, length / 4);
    const double largest = std::min(rays.longest, length * 2);
    std::vector<double> cuts;
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        sum += equal || !(least < largest) ? length : least + (largest - least) * random.next();
        cuts.push_back(sum);
    }
    return cuts;
}

class RayTrial {
  public:
    RayTrial(const TransferFunction& transfer_function, const SegmentLookup& lookup,
             double full_color)
        : transfer_function_(transfer_function), lookup_(lookup), full_color_(full_color) {}

    // In units of full scale.
    double error(const Run& run, const std::vector<double>& cuts) const {
        const double length = cuts.back();
        const SegmentIntegral expected =
            integrate_segment(transfer_function_, run.from, run.to, length);
        double transmittance = 1, start = 0, front = run.from;
        glm::dvec3 color(0);
        for (const double end : cuts) {
            const double share = end / length;
            const double back = run.from * (1 - share) + run.to * share;
            const SegmentIntegral found = lookup_(front, back, end - start);
            color += transmittance * found.color;
            transmittance *= 1 - found.alpha;
            if (transmittance < least_transmittance) break;
            start = end;
            front = back;
        }
        double worst = std::abs(1 - transmittance - expected.alpha);
        for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::abs(color[c] - expected.color[c]) / full_color_);
        }
        return worst;
    }

  private:
    const TransferFunction& transfer_function_;
    const SegmentLookup& lookup_;
    double full_color_;
};

double full_color_of(const TransferFunction& transfer_function) {
    double largest = 1;
    for (const TransferKnot& knot : transfer_function.knots()) {
        for (int c = 0; c < 3; ++c) largest = std::max(largest, knot.optics.color[c]);
    }
    return largest;
}

}  // namespace

double table_error(const TransferFunction& transfer_function, const TableRays& rays,
                   const SegmentLookup& lookup) {
    const std::vector<Run> runs = make_runs(transfer_function, rays);
    const RayTrial trial(transfer_function, lookup, full_color_of(transfer_function));
    std::vector<double> worst(runs.size(), 0);
    parallel_for(static_cast<std::int64_t>(runs.size()), 1, [&](std::int64_t i) {
        Random random(static_cast<std::uint64_t>(i) + 2);
        double& error = worst[static_cast<std::size_t>(i)];
        for (int step = 0; step < length_steps; ++step) {
            const double length =
                rays.shortest * std::pow(rays.longest / rays.shortest, step / (length_steps - 1.0));
            for (const int most : segment_counts) {
                const double fitting = std::max(1.0, rays.ray_length / length);
                const int count = static_cast<int>(std::min<double>(fitting, most));
                for (const bool equal : {true, false}) {
                    const auto cuts = make_cuts(count, length, rays, equal, random);
                    error = std::max(error, trial.error(runs[static_cast<std::size_t>(i)], cuts));
                }
            }
        }
    });
    return 255 * *std::ranges::max_element(worst);
}

}  // namespace lamina
