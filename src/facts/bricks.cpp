// SPDX-License-Identifier: Apache-2.0
#include "facts/bricks.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "base/parallel.h"

namespace lamina {

namespace {

constexpr double edge = MinMaxBricks::edge;

// Returns the number, along one axis, of the brick at (or nearest to) an index-space coordinate.
std::int64_t brick_of(double place, std::int64_t count) {
    return static_cast<std::int64_t>(
        std::clamp(place * (1 / edge), 0.0, static_cast<double>(count - 1)));
}

constexpr std::size_t longest_step = 32;  // largest power of two up to OccupiedBricks::farthest
static_assert(OccupiedBricks::farthest < 2 * longest_step);

std::uint8_t plus(std::uint8_t distance, std::size_t steps) {
    const auto most = static_cast<std::uint8_t>(OccupiedBricks::farthest - steps);
    return static_cast<std::uint8_t>(std::min(distance, most) + steps);
}

// Computes the distances of bricks row by row (along x; y fastest): include() adds a neighbouring
// row that is known, finish() computes the row. So that loops become vector code, buffers continue
// beyond a row's ends with `farthest`, and loops copy members, which stores of bytes might change.
class RowSweep {
  public:
    RowSweep(SparseBytes& distance, std::int64_t across, std::int64_t rows)
        : distance_(distance),
          count_(static_cast<std::size_t>(across)),
          near_(count_ + 2, OccupiedBricks::farthest),
          row_(count_ + 2 * longest_step, OccupiedBricks::farthest),
          next_(row_),
          far_(static_cast<std::size_t>(rows)) {
        const auto code =
            static_cast<std::uint8_t>(OccupiedBricks::farthest ^ distance.background());
        parallel_for(rows, 256, [&](std::int64_t row) {
            far_[static_cast<std::size_t>(row)] =
                all_equal(distance.coded() + first_of(row), count_, code);
        });
    }

    void include(std::int64_t known) {
        if (far_[static_cast<std::size_t>(known)] != 0) return;
        const std::uint8_t* const row = distance_.coded() + first_of(known);
        const std::uint8_t background = distance_.background();
        std::uint8_t* const near = near_.data() + 1;
        for (std::size_t x = 0, count = count_; x < count; ++x)
            near[x] = std::min(near[x], static_cast<std::uint8_t>(row[x] ^ background));
        any_near_ = true;
    }

    void finish(std::int64_t number) {
        std::uint8_t& far = far_[static_cast<std::size_t>(number)];
        if (far != 0 && !any_near_) return;
        const std::size_t first = first_of(number);
        const std::uint8_t* const coded = distance_.coded() + first;
        const std::uint8_t background = distance_.background();
        const std::uint8_t* const near = near_.data();
        std::uint8_t* row = row_.data() + longest_step;
        for (std::size_t x = 0, count = count_; x < count; ++x) {
            const std::uint8_t nearest = std::min(std::min(near[x], near[x + 1]), near[x + 2]);
            row[x] = std::min(static_cast<std::uint8_t>(coded[x] ^ background), plus(nearest, 1));
        }
        for (std::size_t step = 1; step <= longest_step && step < count_; step *= 2)
            row = spread(step);
        distance_.set(first, {row, count_});
        far = all_equal(row, count_, OccupiedBricks::farthest);
        std::ranges::fill(near_, std::uint8_t{OccupiedBricks::farthest});
        any_near_ = false;
    }

  private:
    // Lowers each distance to at most that of the bricks `step` before and behind it, plus `step`.
    // After the steps 1, 2, 4, ..., longest_step all distances along the row are right.
    std::uint8_t* spread(std::size_t step) {
        const std::uint8_t* const from = row_.data() + longest_step;
        std::uint8_t* const to = next_.data() + longest_step;
        for (std::size_t x = 0, count = count_; x < count; ++x)
            to[x] = std::min(from[x], plus(std::min(*(from + x - step), from[x + step]), step));
        std::swap(row_, next_);
        return to;
    }

    std::size_t first_of(std::int64_t row) const { return static_cast<std::size_t>(row) * count_; }

    SparseBytes& distance_;
    std::size_t count_;
    std::vector<std::uint8_t> near_, row_, next_;
    // For each row, 1 if all distances are `farthest`, as in most rows of sparse volumes.
    std::vector<std::uint8_t> far_;
    bool any_near_ = false;
};

constexpr std::size_t most_sampled = 1 << 16;  // largest number of bricks whose kinds are counted

// Red, green, blue and extinction: the kind of a constant brick, as a key of std::map.
using Key = std::array<double, 4>;

Key key_of(const OpticalProperties& optics) {
    return {optics.color.r, optics.color.g, optics.color.b, optics.extinction};
}

// Finds the ConstantBricks of a volume; the members are the arguments of find_constant_bricks().
struct ConstantFinder {
    const TransferFunction& transfer_function;
    const MinMaxBricks& bricks;
    const OccupiedBricks& occupied;
    double margin;
    bool has_plateaus = plateaus_in(transfer_function);

    ConstantBricks find() const {
        const std::vector<Key> keys = common_keys();
        ConstantBricks constant;
        if (keys.empty()) return constant;
        const std::size_t count = bricks.ranges.size();
        constant.kind = SparseBytes(count, 0);
        constant.varied = {bricks.count, SparseBytes(count, 0)};
        parallel_for(static_cast<std::int64_t>(count), 4096, [&](std::int64_t number) {
            const auto i = static_cast<std::size_t>(number);
            const std::optional<Key> key = constant_key(i);
            if (!key) return;
            const auto kind = std::ranges::find(keys, *key);
            if (kind == keys.end()) return;
            constant.kind.set(i, static_cast<std::uint8_t>(kind - keys.begin()));
            constant.varied.distance.set(i, OccupiedBricks::farthest);
        });
        constant.share =
            static_cast<double>(constant.varied.distance.count(OccupiedBricks::farthest)) /
            static_cast<double>(occupied.distance.count(0));
        constant.varied.measure_distances();
        for (const Key& key : keys) constant.kinds.push_back({{key[0], key[1], key[2]}, key[3]});
        return constant;
    }

    static bool plateaus_in(const TransferFunction& function) {
        const auto knots = function.knots();
        const auto flat = [](const TransferKnot& a, const TransferKnot& b) {
            return a.value < b.value && a.optics == b.optics;
        };
        return std::ranges::adjacent_find(knots, flat) != knots.end();
    }

    // Returns the optics of a visible brick if they are constant, else nothing. A brick of a single
    // value is constant unless a step lies so near that rounding may take the value across it.
    std::optional<Key> constant_key(std::size_t brick) const {
        if (occupied.distance[brick] > 0) return {};
        const ValueRange range = bricks.range(brick);
        const auto near = [&](const TransferKnot& knot) { return knot.value <= range.lo + margin; };
        const auto knots = transfer_function.knots();
        const auto first =
            std::ranges::lower_bound(knots, range.lo - margin, {}, &TransferKnot::value);
        const std::span beside(first, std::find_if_not(first, knots.end(), near));
        const bool constant =
            range.lo == range.hi
                ? std::ranges::adjacent_find(beside, {}, &TransferKnot::value) == beside.end()
                : has_plateaus && transfer_function.constant(range.lo - margin, range.hi + margin);
        if (!constant) return {};
        return key_of(transfer_function.at(range.lo));
    }

    // Returns the most frequent kinds in a sample of bricks; none if too few are constant.
    std::vector<Key> common_keys() const {
        const std::size_t count = bricks.ranges.size();
        const std::size_t step = count / most_sampled * 2 + 1;
        std::map<Key, std::size_t> found;
        std::size_t shown = 0, constant = 0;
        for (std::size_t i = 0; i < count; i += step) {
            shown += occupied.distance[i] == 0;
            const std::optional<Key> key = constant_key(i);
            if (!key) continue;
            ++constant;
            ++found[*key];
        }
        if (shown == 0 || static_cast<double>(constant) <
                              ConstantBricks::least_share * static_cast<double>(shown))
            return {};
        std::vector<std::pair<std::size_t, Key>> by_count;
        for (const auto& [key, times] : found) by_count.emplace_back(times, key);
        std::ranges::sort(by_count, std::greater());
        by_count.resize(std::min(by_count.size(), ConstantBricks::most_kinds));
        std::vector<Key> keys;
        for (const auto& [times, key] : by_count) keys.push_back(key);
        return keys;
    }
};

}  // namespace

// A chamfer transform: one sweep forwards, one backwards. It is exact, because a shortest path may
// take its steps in any order, first those in the first sweep's direction.
void OccupiedBricks::measure_distances() {
    // No structured binding: clang below 16 cannot capture one in a lambda.
    const std::int64_t ny = count[1], nz = count[2];
    RowSweep sweep(distance, count[0], ny * nz);
    const auto take_over = [&](std::int64_t y, std::int64_t z, std::int64_t back) {
        if (y + back >= 0 && y + back < ny) sweep.include(z * ny + y + back);
        if (z + back >= 0 && z + back < nz) {
            const std::int64_t end = std::min(y + 2, ny);
            for (std::int64_t by = std::max<std::int64_t>(y - 1, 0); by < end; ++by)
                sweep.include((z + back) * ny + by);
        }
        sweep.finish(z * ny + y);
    };
    for (std::int64_t z = 0; z < nz; ++z) {
        for (std::int64_t y = 0; y < ny; ++y) take_over(y, z, -1);
    }
    for (std::int64_t z = nz; z-- > 0;) {
        for (std::int64_t y = ny; y-- > 0;) take_over(y, z, 1);
    }
}

std::size_t OccupiedBricks::place_of(const glm::dvec3& point) const {
    return place(brick_of(point.x, count[0]), brick_of(point.y, count[1]),
                 brick_of(point.z, count[2]));
}

bool OccupiedBricks::any_in(const glm::dvec3& min, const glm::dvec3& max) const {
    std::array<std::int64_t, 3> first{}, last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = brick_of(min[static_cast<int>(axis)], count[axis]);
        last[axis] = brick_of(max[static_cast<int>(axis)], count[axis]);
    }
    return any_of(first, last);
}

bool OccupiedBricks::any_of(const std::array<std::int64_t, 3>& first,
                            const std::array<std::int64_t, 3>& last) const {
    std::array<std::int64_t, 3> middle{};
    std::int64_t reach = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (first[axis] > last[axis]) return false;
        middle[axis] = std::midpoint(first[axis], last[axis]);
        reach = std::max(reach, last[axis] - middle[axis]);
    }
    if (distance_at(middle[0], middle[1], middle[2]) > reach) return false;
    for (std::int64_t z = first[2]; z <= last[2]; ++z) {
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            const std::size_t end = place(last[0], y, z) + 1;
            if (distance.find(0, place(first[0], y, z), end) < end) return true;
        }
    }
    return false;
}

bool OccupiedBricks::empty_around(const glm::dvec3& point, glm::dvec3& min, glm::dvec3& max) const {
    std::array<std::int64_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        at[axis] = brick_of(point[static_cast<int>(axis)], count[axis]);
    const std::int64_t to_shown = distance_at(at[0], at[1], at[2]);
    const std::int64_t reach = std::max<std::int64_t>(to_shown, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t first = at[axis] - reach + 1, end = at[axis] + reach;
        constexpr double everywhere = std::numeric_limits<double>::infinity();
        min[static_cast<int>(axis)] = first <= 0 ? -everywhere : static_cast<double>(first) * edge;
        max[static_cast<int>(axis)] =
            end >= count[axis] ? everywhere : static_cast<double>(end) * edge;
    }
    return to_shown > 0;
}

ConstantBricks find_constant_bricks(const TransferFunction& transfer_function,
                                    const MinMaxBricks& bricks, const OccupiedBricks& occupied,
                                    double margin) {
    return ConstantFinder{transfer_function, bricks, occupied, margin}.find();
}

}  // namespace lamina
