// SPDX-License-Identifier: Apache-2.0
#include "facts/volume_facts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <span>

#include "base/error.h"
#include "base/parallel.h"
#include "facts/drawn_range.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"
#include "scene/clip.h"
#include "volume/range_answers.h"
#include "volume/volume_data.h"

namespace lamina {

namespace {

// Share of the volume's range by which a brick's range is widened on both sides to tell whether it
// is visible: float32 interpolation may leave the brick's range. Integers are drawn as codes from
// the type's least value, so their margin adds this share of the largest code.
constexpr double range_margin = 1e-6;

double margin_of(const Facts& facts) {
    const ValueRange& range = facts.range;
    double largest = 0;
    if (facts.type != SampleType::float32)
        largest = range.hi + (facts.type == SampleType::int16 ? 32768 : 0);
    return range_margin * (range.hi - range.lo + largest);
}

double side_ratio_of(const Grid& grid) {
    const glm::dvec3 extent = grid.index_max() - grid.index_min();
    const glm::dvec3 sides{extent.x * glm::length(grid.step[0]),
                           extent.y * glm::length(grid.step[1]),
                           extent.z * glm::length(grid.step[2])};
    return std::max({sides.x, sides.y, sides.z}) / std::min({sides.x, sides.y, sides.z});
}

void measure_extinctions(const TransferFunction& transfer_function, const MinMaxBricks& bricks,
                         Facts& facts) {
    const SparseBytes& distance = facts.occupied_bricks.distance;
    const std::size_t count = bricks.ranges.size();
    const double unit = world_unit(box_diagonal(facts.grid));
    // Extinctions are counted by the leading bits of float32, which for floats >= 0 keep the order.
    constexpr int rest_bits = 12;
    const auto leading = [&](double extinction) {
        return std::bit_cast<std::uint32_t>(static_cast<float>(extinction / unit)) >> rest_bits;
    };
    const RangeAnswers<std::uint32_t> keys(bricks.ranges, [&](const ValueRange& range) {
        return leading(transfer_function.max_extinction(range.lo, range.hi));
    });
    const Counts counts =
        count_in_parts(static_cast<std::int64_t>(count), std::size_t{1} << (31 - rest_bits),
                       [&](std::int64_t first, std::int64_t end, std::vector<std::uint32_t>& into) {
                           RangeAnswers<std::uint32_t>::Reader key_of(keys);
                           const auto past = static_cast<std::size_t>(end);
                           auto hidden = static_cast<std::uint32_t>(end - first);
                           for (auto i = static_cast<std::size_t>(first);
                                (i = distance.find(0, i, past)) < past; ++i, --hidden)
                               ++into[key_of[i]];
                           into[0] += hidden;
                       });
    const auto quantile = [&](double share) {
        auto rank = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count - 1)));
        std::uint32_t key = 0;
        while (rank >= counts[key]) rank -= counts[key++];
        return double{std::bit_cast<float>(key << rest_bits)} * unit;
    };
    facts.extinction_quantiles = {quantile(.5), quantile(.9), quantile(1)};
}

// Largest optical depth (.026 / 255 in a picture) that a ray may lose to bricks that count as
// transparent: rounding may show a little if extinction rises from 0 at a brick's extreme.
constexpr double faint_depth = 1e-4;

double faint_extinction(const Facts& facts) {
    return faint_depth / (box_diagonal(facts.grid) * std::max(facts.max_color, 1.0));
}

// Returns the part of the volume's box that the bricks first .. last hold.
IndexBox box_of_bricks(const Grid& grid, const std::array<std::int64_t, 3>& count,
                       const std::array<std::int64_t, 3>& first,
                       const std::array<std::int64_t, 3>& last) {
    IndexBox box{grid.index_min(), grid.index_max()};
    for (int axis = 0; axis < 3; ++axis) {
        // The outermost bricks include the half voxels beyond the samples of `cell` axes.
        if (first[axis] > 0) box.min[axis] = static_cast<double>(first[axis] * MinMaxBricks::edge);
        if (last[axis] + 1 < count[axis])
            box.max[axis] = static_cast<double>((last[axis] + 1) * MinMaxBricks::edge);
    }
    return box;
}

// Marks bricks as empty if a plane of the clip cuts all of the brick away.
void empty_cut_bricks(Facts& facts) {
    OccupiedBricks& occupied = facts.occupied_bricks;
    const auto [nx, ny, nz] = occupied.count;
    const std::int64_t columns = nx, rows = ny;  // clang below 16 has no bindings in lambdas
    const auto cut_away = [&](const IndexBox& box) {
        return std::ranges::any_of(facts.clip, [&](const IndexPlane& plane) {
            return plane.largest_distance(box.min, box.max) <= 0;
        });
    };
    parallel_for(nz, 1, [&](std::int64_t z) {
        for (std::int64_t y = 0; y < rows; ++y) {
            for (std::int64_t x = 0; x < columns; ++x) {
                const std::size_t place = occupied.place(x, y, z);
                const std::array<std::int64_t, 3> brick{x, y, z};
                if (occupied.distance[place] == 0 &&
                    cut_away(box_of_bricks(facts.grid, occupied.count, brick, brick)))
                    occupied.distance.set(place, OccupiedBricks::farthest);
            }
        }
    });
}

void find_occupied(const TransferFunction& transfer_function, const MinMaxBricks& bricks,
                   Facts& facts) {
    constexpr std::uint8_t hidden = OccupiedBricks::farthest;
    constexpr std::size_t together = 1 << 17;
    OccupiedBricks& occupied = facts.occupied_bricks;
    const double margin = margin_of(facts), faint = faint_extinction(facts);
    const RangeAnswers<std::uint8_t> distances(bricks.ranges, [&](const ValueRange& range) {
        if (range.empty() || facts.max_extinction == 0) return hidden;
        const double most = transfer_function.max_extinction(range.lo - margin, range.hi + margin);
        const bool shows =
            most > faint || (most > 0 && !transfer_function.transparent(range.lo, range.hi));
        return shows ? std::uint8_t{0} : hidden;
    });
    occupied = {bricks.count, SparseBytes(bricks.ranges.size(), hidden)};
    const std::size_t count = bricks.ranges.size();
    parallel_for(static_cast<std::int64_t>((count + together - 1) / together), 1,
                 [&](std::int64_t part) {
                     const std::size_t first = static_cast<std::size_t>(part) * together;
                     RangeAnswers<std::uint8_t>::Reader distance(distances);
                     std::vector<std::uint8_t> of_part(std::min(together, count - first));
                     distance.fill(first, of_part);
                     occupied.distance.set(first, of_part);
                 });
    if (!facts.clip.empty()) {
        const bool some = occupied.distance.count(0) > 0;
        empty_cut_bricks(facts);
        facts.clipped_away = some && occupied.distance.count(0) == 0;
    }
    occupied.measure_distances();
}

// Number of the visible bricks in one or more planes of bricks, and the box of bricks around them.
struct SeenBricks {
    std::int64_t count = 0;
    std::array<std::int64_t, 3> first{INT64_MAX, INT64_MAX, INT64_MAX};
    std::array<std::int64_t, 3> last{-1, -1, -1};

    void add(const std::array<std::int64_t, 3>& brick) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = std::min(first[axis], brick[axis]);
            last[axis] = std::max(last[axis], brick[axis]);
        }
    }
    void join(const SeenBricks& other) {
        if (other.count == 0) return;
        count += other.count;
        add(other.first);
        add(other.last);
    }
};

// Finds the visible bricks of plane z. SparseBytes::coded() stores distance 0 as the background.
SeenBricks seen_in_plane(const OccupiedBricks& occupied, std::int64_t z) {
    const std::uint8_t shown = occupied.distance.background();
    SeenBricks seen;
    for (std::int64_t y = 0; y < occupied.count[1]; ++y) {
        const std::size_t begin = occupied.place(0, y, z), end = occupied.place(0, y + 1, z);
        const std::size_t first = occupied.distance.find(0, begin, end);
        if (first == end) continue;
        const std::span row(occupied.distance.coded() + begin, end - begin);
        seen.count += std::ranges::count(row, shown);
        seen.add({static_cast<std::int64_t>(first - begin), y, z});
        seen.add({std::find(row.rbegin(), row.rend(), shown).base() - row.begin() - 1, y, z});
    }
    return seen;
}

void measure_occupied(const TransferFunction& transfer_function, const MinMaxBricks& bricks,
                      Facts& facts) {
    find_occupied(transfer_function, bricks, facts);
    std::vector<SeenBricks> of_planes(static_cast<std::size_t>(bricks.count[2]));
    parallel_for(bricks.count[2], 1, [&](std::int64_t z) {
        of_planes[static_cast<std::size_t>(z)] = seen_in_plane(facts.occupied_bricks, z);
    });
    SeenBricks seen;
    for (const SeenBricks& of_plane : of_planes) seen.join(of_plane);
    facts.occupied_share =
        static_cast<double>(seen.count) / static_cast<double>(bricks.ranges.size());
    facts.occupied = {};
    if (seen.count > 0)
        facts.occupied = box_of_bricks(facts.grid, bricks.count, seen.first, seen.last);
}

// Tells whether segments may need a table. A single linear piece needs none if the longest possible
// segment, from the nearest to the farthest depth, is thin.
bool may_need_table(const Scene& scene, const Facts& facts) {
    const double depth =
        facts.max_extinction * (facts.far_depth - facts.near_depth) * facts.max_length_per_depth;
    return scene.slice.classification == Classification::preintegrated && !facts.constant &&
           !facts.single_color && (facts.pieces > 1 || depth > thin_depth);
}

}  // namespace

DepthRange depth_range(const Grid& grid, const View& view) {
    return depth_range(grid, {grid.index_min(), grid.index_max()}, view);
}

DepthRange depth_range(const Grid& grid, const IndexBox& box, const View& view) {
    const glm::dvec3 lo = box.min, hi = box.max;
    DepthRange depth{INFINITY, -INFINITY};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index{(corner & 1) != 0 ? hi.x : lo.x, (corner & 2) != 0 ? hi.y : lo.y,
                               (corner & 4) != 0 ? hi.z : lo.z};
        const double z = glm::dot(grid.to_world(index) - view.eye, view.forward);
        depth.near = std::min(depth.near, z);
        depth.far = std::max(depth.far, z);
    }
    depth.near = std::max(depth.near, 0.0);
    return depth;
}

void measure_view(const Scene& scene, Facts& facts) {
    const View view(*scene.camera, scene.width, scene.height);
    const glm::dvec3 lo = facts.grid.index_min(), hi = facts.grid.index_max();
    facts.orthographic = view.projection == Projection::orthographic;
    const glm::dvec3 eye = facts.grid.to_index(view.eye);
    facts.eye_inside = !facts.orthographic && glm::clamp(eye, lo, hi) == eye;
    const DepthRange depth = depth_range(facts.grid, view);
    facts.near_depth = depth.near;
    facts.far_depth = depth.far;
    const double index_speed = glm::length(facts.grid.direction_to_index(view.forward));
    facts.voxels_along_view = std::max(0.0, depth.far - depth.near) * index_speed;
    facts.occupied_depth = depth_range(facts.grid, facts.occupied, view);
    facts.max_length_per_depth = 1;
    if (!facts.orthographic) {
        const double x = view.x(scene.width - 1), y = view.y(0);
        facts.max_length_per_depth = std::sqrt(1 + x * x + y * y);
    }
}

Facts measure(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks) {
    Facts facts = measure_data(scene, volume, bricks);
    measure_view(scene, facts);
    facts.ray_shares = measure_ray_shares(scene, volume, facts);
    facts.scalar_rays = measure_scalar_rays(scene, volume, facts);
    return facts;
}

Facts measure_data(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks) {
    Facts facts;
    facts.grid = volume.grid();
    facts.clip = index_planes(scene.clip, facts.grid);
    facts.type = volume.type();
    facts.range = bricks.whole;
    facts.non_finite = bricks.non_finite;
    check_finite(scene, volume.grid(), bricks);
    facts.side_ratio = side_ratio_of(facts.grid);
    const TransferFunction& transfer_function = *scene.transfer_function;
    facts.constant = transfer_function.constant(facts.range.lo, facts.range.hi);
    facts.single_color = transfer_function.single_color(facts.range.lo, facts.range.hi);
    facts.max_extinction = transfer_function.max_extinction(facts.range.lo, facts.range.hi);
    facts.max_color = largest_color(transfer_function, facts.range);
    facts.knots = std::ranges::count_if(transfer_function.knots(), [&](const TransferKnot& knot) {
        return knot.value > facts.range.lo && knot.value < facts.range.hi;
    });
    const ValueRange drawn = drawn_range(transfer_function, facts.range);
    const auto count = [&](bool curved) {
        return std::ssize(pieces_between(transfer_function, drawn.lo, drawn.hi, curved));
    };
    facts.pieces = count(false);
    facts.curves = count(true);
    measure_occupied(transfer_function, bricks, facts);
    measure_extinctions(transfer_function, bricks, facts);
    // Ranges ignore samples that are not finite, so they do not tell that a brick is constant.
    if (facts.non_finite == 0)
        facts.constant_bricks = find_constant_bricks(transfer_function, bricks,
                                                     facts.occupied_bricks, margin_of(facts));
    return facts;
}

ScalarRays measure_scalar_rays(const Scene& scene, const Volume& volume, const Facts& facts) {
    return may_need_table(scene, facts) ? sample_rays(scene, volume, facts) : ScalarRays();
}

void check_finite(const Scene& scene, const Grid& grid, const MinMaxBricks& bricks) {
    const VolumeFile* const file = scene.volume_file();
    const std::string name = file == nullptr ? "volume" : file->path.string();
    const std::int64_t samples = grid.sample_count();
    if (bricks.non_finite == samples) fail("{}: all {} samples are NaN or infinite", name, samples);
    if (bricks.non_finite > 0 && scene.nan == NanPolicy::error) {
        fail(
            "{}: found {} NaN or infinite samples of {}, expected none; \"nan\": \"transparent\" "
            "in the scene (--set nan=transparent; in Python nan=\"transparent\") draws their cells "
            "as transparent",
            name, bricks.non_finite, samples);
    }
}

double IndexPlane::distance(const glm::dvec3& index) const {
    return glm::dot(normal, index) + offset;
}

double IndexPlane::least_distance(const glm::dvec3& min, const glm::dvec3& max) const {
    return distance(0.5 * (min + max)) - glm::dot(glm::abs(normal), 0.5 * (max - min));
}

double IndexPlane::largest_distance(const glm::dvec3& min, const glm::dvec3& max) const {
    return distance(0.5 * (min + max)) + glm::dot(glm::abs(normal), 0.5 * (max - min));
}

std::vector<IndexPlane> index_planes(const Clip& clip, const Grid& grid) {
    std::vector<IndexPlane> planes;
    for (const HalfSpace& half : half_spaces(clip)) {
        glm::dvec3 slope(0);
        for (std::size_t axis = 0; axis < 3; ++axis)
            slope[static_cast<int>(axis)] = glm::dot(half.normal, grid.step[axis]);
        // Hypot() does not underflow if voxels are tiny.
        const double length = std::hypot(slope.x, slope.y, slope.z);
        planes.push_back(
            {slope / length, glm::dot(half.normal, grid.index_origin() - half.point) / length});
    }
    return planes;
}

std::vector<IndexPlane> cutting_planes(std::vector<IndexPlane> planes, const Grid& grid) {
    const glm::dvec3 min = grid.index_min(), max = grid.index_max();
    std::erase_if(planes,
                  [&](const IndexPlane& plane) { return plane.least_distance(min, max) >= 0; });
    return planes;
}

}  // namespace lamina
