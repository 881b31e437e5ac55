// SPDX-License-Identifier: Apache-2.0
#include "facts/constant_bricks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "base/parallel.h"

namespace lamina {
namespace {

constexpr std::size_t most_sampled = 1 << 16;  // number of bricks whose kinds are counted

using Key = std::array<double, 4>;

Key key_of(const OpticalProperties& optics) {
    return {optics.color.r, optics.color.g, optics.color.b, optics.extinction};
}

class ConstantFinder {
  public:
    ConstantFinder(const TransferFunction& transfer_function, const MinMaxBricks& bricks,
                   const OccupiedBricks& occupied, double margin)
        : transfer_function_(transfer_function),
          bricks_(bricks),
          occupied_(occupied),
          margin_(margin),
          has_plateaus_(has_plateaus(transfer_function)) {}

    ConstantBricks find() const {
        const std::vector<Key> keys = common_keys();
        ConstantBricks constant;
        if (keys.empty()) return constant;
        const std::size_t count = bricks_.ranges.size();
        constant.kind = SparseBytes(count, 0);
        constant.varied = {bricks_.count, SparseBytes(count, 0)};
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
            static_cast<double>(occupied_.distance.count(0));
        constant.varied.measure_distances();
        for (const Key& key : keys) constant.kinds.push_back({{key[0], key[1], key[2]}, key[3]});
        return constant;
    }

  private:
    static bool has_plateaus(const TransferFunction& transfer_function) {
        const auto knots = transfer_function.knots();
        const auto flat = [](const TransferKnot& a, const TransferKnot& b) {
            return a.value < b.value && a.optics == b.optics;
        };
        return std::ranges::adjacent_find(knots, flat) != knots.end();
    }

    // Returns the optics of a visible brick if they are constant. A brick of one value has that
    // value's optics, unless rounding might take it across a step.
    std::optional<Key> constant_key(std::size_t brick) const {
        if (occupied_.distance[brick] > 0) return {};
        const ValueRange range = bricks_.range(brick);
        const auto beside = [&](const TransferKnot& a, const TransferKnot& b) {
            return a.value == b.value && std::abs(a.value - range.lo) <= margin_;
        };
        const auto knots = transfer_function_.knots();
        const bool constant = range.lo == range.hi
                                  ? std::ranges::adjacent_find(knots, beside) == knots.end()
                                  : has_plateaus_ && transfer_function_.constant(
                                                         range.lo - margin_, range.hi + margin_);
        if (!constant) return {};
        return key_of(transfer_function_.at(range.lo));
    }

    // Returns the most frequent kinds first; nothing if too few bricks are constant.
    std::vector<Key> common_keys() const {
        const std::size_t count = bricks_.ranges.size();
        const std::size_t step = count / most_sampled * 2 + 1;
        std::map<Key, std::size_t> found;
        std::size_t shown = 0, constant = 0;
        for (std::size_t i = 0; i < count; i += step) {
            shown += occupied_.distance[i] == 0;
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

    const TransferFunction& transfer_function_;
    const MinMaxBricks& bricks_;
    const OccupiedBricks& occupied_;
    double margin_;
    bool has_plateaus_;
};

}  // namespace

ConstantBricks find_constant_bricks(const TransferFunction& transfer_function,
                                    const MinMaxBricks& bricks, const OccupiedBricks& occupied,
                                    double margin) {
    return ConstantFinder(transfer_function, bricks, occupied, margin).find();
}

}  // namespace lamina
