// SPDX-License-Identifier: Apache-2.0
#include "choice/constant_border.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "choice/field.h"

namespace lamina {

namespace {

// Layers are no border if at least this share of the samples behind them has their value: then they
// are the empty space around a thing.
constexpr double most_alike = .5;
// Share of the range by which a thing is higher than the empty space around it; air in a border of
// a lower value is not.
constexpr double least_rise = .25;
// One sample in so many of a layer may have another value: marks are burnt into borders, too. None
// if the layer has the lowest value of all: others are then more probably things in empty space.
constexpr std::int64_t odd_share = 1000;
constexpr std::int64_t most_share = 3;  // at least 1 / most_share of an axis is inside
// Number of samples from which a median is taken; of larger layers every n-th counts.
constexpr std::int64_t most_for_median = std::int64_t{1} << 20;

// Takes layers away from the sides of a volume, once from each side.
template <typename T>
class Peeling {
  public:
    Peeling(const Volume& volume, const ValueRange& range) : volume_(volume), range_(range) {}

    // Sides whose layers are no border are left as they are, and the others are sought again: they
    // may reach farther then.
    ConstantBorder peel() {
        do {
            found_ = {};
            found_.inside.size = volume_.grid().size;
            done_ = left_;
            for (bool more = true; more;) {
                more = false;
                for (const std::size_t axis : {2, 1, 0}) {
                    for (const bool upper : {false, true}) more = take_away(axis, upper) || more;
                }
            }
        } while (leave_no_borders());
        for (BorderLayers& layers : found_.layers) list_odd(layers);
        return std::move(found_);
    }

  private:
    // Returns the layers number first .. first + count - 1, counted inwards from a side.
    SampleBox layers(std::size_t axis, bool upper, std::int64_t first, std::int64_t count) const {
        SampleBox box = found_.inside;
        box.first[axis] += upper ? box.size[axis] - first - count : first;
        box.size[axis] = count;
        return box;
    }

    // Calls visit(begin, end) for the box's rows of samples along x until it returns false. Returns
    // its last result.
    template <typename Visit>
    bool for_each_row(const SampleBox& box, const Visit& visit) const {
        const std::size_t across = box.size[2] > 1 ? 2 : 1;
        if (!volume_.in_memory() && box.count() > most_read && box.size[across] > 1) {
            SampleBox first = box, second = box;
            first.size[across] /= 2;
            second.first[across] += first.size[across];
            second.size[across] -= first.size[across];
            return for_each_row(first, visit) && for_each_row(second, visit);
        }
        return visit_window<T>(volume_, box, [&](const SampleWindow<T>& window) {
            for (std::int64_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
                for (std::int64_t y = box.first[1]; y < box.first[1] + box.size[1]; ++y) {
                    const T* const row = window.row(y, z) + (box.first[0] - window.box.first[0]);
                    if (!visit(row, row + box.size[0])) return false;
                }
            }
            return true;
        });
    }

    // Returns the share of samples that have a value.
    double share(const SampleBox& box, T value) const {
        std::int64_t alike = 0;
        for_each_row(box, [&](const T* begin, const T* end) {
            alike += std::count(begin, end, value);
            return true;
        });
        return static_cast<double>(alike) / static_cast<double>(box.count());
    }

    // Tells if at most `odd` samples have another value.
    bool almost_all_are(const SampleBox& box, T value, std::int64_t odd) const {
        return for_each_row(box, [&](const T* begin, const T* end) {
            odd -= (end - begin) - std::count(begin, end, value);
            return odd >= 0;
        });
    }

    // Returns the number of layers, up to `most`, whose samples have a value, but for a few.
    std::int64_t width(std::size_t axis, bool upper, T value, std::int64_t most) const {
        std::int64_t found = 0;
        const std::int64_t odd = static_cast<double>(value) == range_.lo
                                     ? 0
                                     : layers(axis, upper, 0, 1).count() / odd_share;
        if (axis > 0) {
            while (found < most && almost_all_are(layers(axis, upper, found, 1), value, odd))
                ++found;
            return found;
        }
        // Layers across x lie apart in memory, so rows are read instead, plane by plane.
        found = most;
        std::vector<std::int64_t> odd_in(static_cast<std::size_t>(most));
        const SampleBox& inside = found_.inside;
        for (std::int64_t z = 0; z < inside.size[2] && found > 0; ++z) {
            SampleBox plane = layers(axis, upper, 0, found);
            plane.first[2] += z;
            plane.size[2] = 1;
            for_each_row(plane, [&](const T* begin, const T* end) {
                for (std::int64_t i = 0; i < found; ++i) {
                    if ((upper ? end[-1 - i] : begin[i]) != value &&
                        ++odd_in[static_cast<std::size_t>(i)] > odd)
                        found = i;
                }
                return found > 0;
            });
        }
        return found;
    }

    // `otherwise`: returned if all are NaN, which has no order.
    double median(const SampleBox& box, double otherwise) const {
        const std::int64_t step = (box.count() - 1) / most_for_median + 1;
        std::vector<T> values;
        values.reserve(static_cast<std::size_t>(box.count() / step + 1));
        std::int64_t next = 0;  // counted from the beginning of the row
        for_each_row(box, [&](const T* begin, const T* end) {
            for (; next < end - begin; next += step)
                if (begin[next] == begin[next]) values.push_back(begin[next]);
            next -= end - begin;
            return true;
        });
        if (values.empty()) return otherwise;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::ranges::nth_element(values, middle);
        return static_cast<double>(*middle);
    }

    T sample(const std::array<std::int64_t, 3>& at) const {
        return visit_window<T>(
            volume_, SampleBox{at, {1, 1, 1}},
            [&](const SampleWindow<T>& window) { return window.at(at[0], at[1], at[2]); });
    }

    // Returns the value that most of a layer has if it is almost constant, although a corner or the
    // middle may be odd.
    T value_of(const SampleBox& layer) const {
        std::array<std::int64_t, 3> middle{}, last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            middle[axis] = layer.first[axis] + layer.size[axis] / 2;
            last[axis] = layer.first[axis] + layer.size[axis] - 1;
        }
        const T first = sample(layer.first);
        return sample(middle) == sample(last) ? sample(last) : first;
    }

    void list_odd(BorderLayers& layers) const {
        const auto& size = volume_.grid().size;
        const SampleBox& box = layers.samples;
        for (std::int64_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
            SampleBox plane = box;
            plane.first[2] = z;
            plane.size[2] = 1;
            std::int64_t y = box.first[1];
            for_each_row(plane, [&](const T* begin, const T* end) {
                for (const T* at = begin; at != end; ++at) {
                    if (static_cast<double>(*at) == layers.value) continue;
                    layers.odd.push_back({(z * size[1] + y) * size[0] + box.first[0] + (at - begin),
                                          static_cast<double>(*at)});
                }
                ++y;
                return true;
            });
        }
    }

    bool take_away(std::size_t axis, bool upper) {
        const std::int64_t size = volume_.grid().size[axis];
        const std::int64_t most = found_.inside.size[axis] - size / most_share - 1;
        bool& done = done_[axis][upper ? 1 : 0];
        if (most <= 0 || done) return false;
        const T value = value_of(layers(axis, upper, 0, 1));
        const std::int64_t alike = width(axis, upper, value, most);
        if (alike == 0) return false;
        found_.layers.push_back(
            {axis, upper, alike, static_cast<double>(value), 0, layers(axis, upper, 0, alike)});
        found_.inside = layers(axis, upper, alike, found_.inside.size[axis] - alike);
        return done = true;
    }

    // Tells if layers of the same value lie at sides along other axes, too.
    bool is_around(const BorderLayers& found) const {
        return std::ranges::any_of(found_.layers, [&](const BorderLayers& one) {
            return one.axis != found.axis && one.value == found.value;
        });
    }

    // Tells if layers are a border of what lies behind them, whose median is set then. They are not
    // if they are the empty space around a thing, or if the samples behind them have one value,
    // too, as in a field that varies along one axis alone; behind a frame there may be clean air.
    bool is_border(BorderLayers& found) const {
        const SampleBox behind = layers(found.axis, found.upper, 0, 1);
        if (!is_around(found) && almost_all_are(behind, sample(behind.first), 0)) return false;
        found.behind = median(behind, found.value);
        const bool space =
            found.value == range_.lo &&
            found.behind / 2 - range_.lo / 2 > least_rise * (range_.hi / 2 - range_.lo / 2);
        return !space && share(behind, static_cast<T>(found.value)) < most_alike;
    }

    // Marks sides whose layers are no border. Returns false if there are none.
    bool leave_no_borders() {
        bool any = false;
        for (BorderLayers& one : found_.layers) {
            if (!is_border(one)) any = left_[one.axis][one.upper ? 1 : 0] = true;
        }
        return any;
    }

    const Volume& volume_;
    const ValueRange range_;
    // By axis and side: sides whose layers are no border, and those and the sides that are taken.
    std::array<std::array<bool, 2>, 3> left_{}, done_{};
    ConstantBorder found_;
};

}  // namespace

std::optional<ConstantBorder> find_constant_border(const Volume& volume, const ValueRange& range) {
    if (volume.grid().sample_count() > large_volume) return std::nullopt;
    ConstantBorder found = with_sample_type(
        volume.type(), [&](auto zero) { return Peeling<decltype(zero)>(volume, range).peel(); });
    if (found.layers.empty()) return std::nullopt;
    return found;
}

}  // namespace lamina
