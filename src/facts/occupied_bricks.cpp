// SPDX-License-Identifier: Apache-2.0
#include "facts/occupied_bricks.h"

#include <algorithm>
#include <limits>

namespace lamina {
namespace {

constexpr double edge = MinMaxBricks::edge;

std::int64_t brick_of(double place, std::int64_t count) {
    return static_cast<std::int64_t>(
        std::clamp(place * (1 / edge), 0.0, static_cast<double>(count - 1)));
}

// The largest power of two among distances.
constexpr std::size_t longest_step = 32;
static_assert(OccupiedBricks::farthest < 2 * longest_step);

std::uint8_t plus(std::uint8_t distance, std::size_t steps) {
    const auto most = static_cast<std::uint8_t>(OccupiedBricks::farthest - steps);
    return static_cast<std::uint8_t>(std::min(distance, most) + steps);
}

// Takes over what is near in rows that are known already, each brick and its two neighbours there.
// Beyond a row's ends nothing is near, so that loops have no ends of their own and are vectors.
class RowSweep {
  public:
    RowSweep(SparseBytes& distance, std::int64_t count)
        : distance_(distance),
          count_(static_cast<std::size_t>(count)),
          near_(count_ + 2, OccupiedBricks::farthest),
          row_(count_ + 2 * longest_step, OccupiedBricks::farthest),
          next_(row_) {}

    void begin() { std::ranges::fill(near_, std::uint8_t{OccupiedBricks::farthest}); }

    // Rows are told by the place of their first brick.
    void include(std::size_t first) {
        const std::uint8_t* const row = distance_.coded() + first;
        const std::uint8_t background = distance_.background();
        for (std::size_t x = 0; x < count_; ++x)
            near_[x + 1] = std::min(near_[x + 1], static_cast<std::uint8_t>(row[x] ^ background));
    }

    void finish(std::size_t first) {
        const std::uint8_t* const coded = distance_.coded() + first;
        const std::uint8_t background = distance_.background();
        std::uint8_t* row = row_.data() + longest_step;
        for (std::size_t x = 0; x < count_; ++x) {
            const std::uint8_t near = std::min(std::min(near_[x], near_[x + 1]), near_[x + 2]);
            row[x] = std::min(static_cast<std::uint8_t>(coded[x] ^ background), plus(near, 1));
        }
        for (std::size_t step = 1; step <= longest_step && step < count_; step *= 2)
            row = spread(step);
        distance_.set(first, {row, count_});
    }

  private:
    // Along the row, by so many bricks: after steps of 1, 2, 4 and so on each brick has heard of
    // all others.
    std::uint8_t* spread(std::size_t step) {
        const std::uint8_t* const from = row_.data() + longest_step;
        std::uint8_t* const to = next_.data() + longest_step;
        for (std::size_t x = 0; x < count_; ++x)
            to[x] = std::min(from[x], plus(std::min(*(from + x - step), from[x + step]), step));
        std::swap(row_, next_);
        return to;
    }

    SparseBytes& distance_;
    std::size_t count_;
    std::vector<std::uint8_t> near_, row_, next_;
};

}  // namespace

// The two sweeps of a chamfer transform, which is exact for this distance: a shortest path takes
// its steps in any order, all that lead on in the first sweep's direction first.
void OccupiedBricks::measure_distances() {
    // No structured binding: clang below 16 has none in lambdas.
    const std::int64_t nx = count[0], ny = count[1], nz = count[2];
    RowSweep sweep(distance, nx);
    const auto row = [&](std::int64_t y, std::int64_t z) {
        return static_cast<std::size_t>((z * ny + y) * nx);
    };
    const auto take_over = [&](std::int64_t y, std::int64_t z, std::int64_t back) {
        sweep.begin();
        if (y + back >= 0 && y + back < ny) sweep.include(row(y + back, z));
        if (z + back >= 0 && z + back < nz) {
            const std::int64_t end = std::min(y + 2, ny);
            for (std::int64_t by = std::max<std::int64_t>(y - 1, 0); by < end; ++by)
                sweep.include(row(by, z + back));
        }
        sweep.finish(row(y, z));
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
    for (std::int64_t z = first[2]; z <= last[2]; ++z) {
        for (std::int64_t y = first[1]; y <= last[1]; ++y) {
            const std::uint8_t* const row = distance.coded() + (z * count[1] + y) * count[0];
            for (std::int64_t x = first[0]; x <= last[0]; ++x) {
                if (row[x] == distance.background()) return true;  // the code of 0
            }
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

}  // namespace lamina
