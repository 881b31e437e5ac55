// SPDX-License-Identifier: Apache-2.0
#include "volume/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <numeric>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

using Size = std::array<std::int64_t, 3>;

constexpr double least_equal = .95, least_equal_pairs = .5;
constexpr std::int64_t all_measured = std::int64_t{1} << 24;  // samples
constexpr std::int64_t some_measured = std::int64_t{1} << 21;
constexpr std::int64_t fewest_rows = 64;

// How often a value occurs, and in how many pairs of neighbours, equal and different ones.
struct Tally {
    std::int64_t samples = 0, equal = 0, different = 0;
};

// The rows of a volume that are measured: all, or every step-th in the order of the file. The step
// is coprime to the rows of a slice, so that rows do not lie above one another.
struct MeasuredRows {
    explicit MeasuredRows(const Size& size) : rows(size[1] * size[2]) {
        if (rows * size[0] <= all_measured) return;
        const std::int64_t wanted = std::max(fewest_rows, some_measured / size[0]);
        step = std::max<std::int64_t>(1, rows / wanted);
        while (step > 1 && std::gcd(step, size[1]) > 1) ++step;
    }
    std::int64_t count() const { return (rows + step - 1) / step; }

    std::int64_t rows, step = 1;
};

// Measures samples of type T. window(y, z) returns a SampleWindow that holds the row (y, z) and its
// neighbours, whole.
template <typename T, typename Window>
class LabelMeasure {
  public:
    LabelMeasure(const Size& size, const Window& window)
        : size_(size), rows_(size), window_(window) {}

    std::optional<double> share() {
        equal_six_ = 0;
        for_rows([&](std::int64_t first, std::int64_t end) { count_equal(first, end); });
        const double measured = static_cast<double>(rows_.count() * size_[0]);
        const double share = static_cast<double>(equal_six_) / measured;
        if (!whole_ || share < least_equal) return {};
        for_rows([&](std::int64_t first, std::int64_t end) { tally(first, end); });
        return has_few_values() && pairs_are_equal() ? std::optional(share) : std::nullopt;
    }

  private:
    template <typename Part>
    void for_rows(const Part& part) {
        constexpr std::int64_t rows_together = 256;
        const std::int64_t count = rows_.count();
        parallel_for((count + rows_together - 1) / rows_together, 1, [&](std::int64_t i) {
            part(i * rows_together, std::min(count, (i + 1) * rows_together));
        });
    }

    // Calls visit(row, rows beside it: before and after along y, then along z) for some rows.
    template <typename Visit>
    void for_each_row(std::int64_t first, std::int64_t end, const Visit& visit) const {
        for (std::int64_t number = first; number < end; ++number) {
            const std::int64_t y = number * rows_.step % size_[1];
            const std::int64_t z = number * rows_.step / size_[1];
            const auto window = window_(y, z);
            visit(window.row(y, z),
                  std::array<const T*, 4>{window.row(y - 1, z), window.row(y + 1, z),
                                          window.row(y, z - 1), window.row(y, z + 1)});
        }
    }

    void count_equal(std::int64_t first, std::int64_t end) {
        std::int64_t equal = 0;
        bool whole = true;
        for_each_row(first, end, [&](const T* row, const std::array<const T*, 4>& beside) {
            const std::int64_t last = size_[0] - 1;
            std::int64_t along = 0;
            for (std::int64_t x = 0; x <= last; ++x) {
                const T value = row[x];
                bool same = value == row[std::max<std::int64_t>(x - 1, 0)];
                same &= value == row[std::min(x + 1, last)];
                for (const T* other : beside) same &= value == other[x];
                along += same ? 1 : 0;
                whole &= is_whole_label(value);
            }
            equal += along;
        });
        const std::lock_guard lock(merging_);
        equal_six_ += equal;
        whole_ &= whole;
    }

    // Counts values, and pairs of a sample and its next neighbour along each axis.
    void tally(std::int64_t first, std::int64_t end) {
        std::unordered_map<T, Tally> found;
        for_each_row(first, end, [&](const T* row, const std::array<const T*, 4>& beside) {
            Tally* current = nullptr;
            for (std::int64_t x = 0; x < size_[0]; ++x) {
                const T value = row[x];
                if (x == 0 || value != row[x - 1]) current = &found[value];
                ++current->samples;
                const auto add = [&](T next) {
                    if (next == value) {
                        ++current->equal;
                    } else {
                        ++current->different;
                        ++found[next].different;
                    }
                };
                // A row at the border is its own neighbour, which makes no pair.
                if (x + 1 < size_[0]) add(row[x + 1]);
                if (beside[1] != row) add(beside[1][x]);
                if (beside[3] != row) add(beside[3][x]);
            }
        });
        const std::lock_guard lock(merging_);
        if (tallies_.size() > most_label_codes) return;
        for (const auto& [value, one] : found) {
            Tally& sum = tallies_[value];
            sum.samples += one.samples;
            sum.equal += one.equal;
            sum.different += one.different;
        }
    }

    bool has_few_values() const {
        return tallies_.size() > 1 && tallies_.size() <= most_label_codes;
    }

    bool pairs_are_equal() const {
        Tally all, common;
        for (const auto& [value, one] : tallies_) {
            all.equal += one.equal;
            all.different += one.different;
            if (one.samples > common.samples) common = one;
        }
        const std::int64_t equal = all.equal - common.equal;
        const std::int64_t different = all.different / 2 - common.different;  // each counts twice
        return equal > 0 && static_cast<double>(equal) >=
                                least_equal_pairs * static_cast<double>(equal + different);
    }

    Size size_;
    MeasuredRows rows_;
    const Window& window_;
    std::mutex merging_;
    std::int64_t equal_six_ = 0;
    bool whole_ = true;
    std::unordered_map<T, Tally> tallies_;
};

template <typename T, typename Window>
std::optional<double> measured(const Size& size, const Window& window) {
    return LabelMeasure<T, Window>(size, window).share();
}

// The rows around one row of a volume in its files.
template <typename T>
struct ReadRows {
    std::vector<T> samples;
    SampleWindow<T> window;

    const T* row(std::int64_t y, std::int64_t z) const { return window.row(y, z); }
};

template <typename T>
ReadRows<T> rows_around(const SampleSource& source, const Size& size, std::int64_t y,
                        std::int64_t z) {
    ReadRows<T> read;
    SampleBox& box = read.window.box;
    box.size[0] = size[0];
    const std::int64_t at[] = {0, y, z};
    for (std::size_t axis = 1; axis < 3; ++axis) {
        box.first[axis] = std::max<std::int64_t>(at[axis] - 1, 0);
        box.size[axis] = std::min(at[axis] + 2, size[axis]) - box.first[axis];
    }
    read.samples.resize(static_cast<std::size_t>(box.count()));
    source.read(box, read.samples.data());
    read.window.samples = read.samples.data();
    return read;
}

}  // namespace

std::optional<double> share_if_labels(const Size& size, ValueType type, const void* samples) {
    return with_type(type, [&](auto zero) {
        using T = decltype(zero);
        const SampleWindow<T> whole{{{0, 0, 0}, size}, static_cast<const T*>(samples)};
        return measured<T>(size, [&](std::int64_t, std::int64_t) { return whole; });
    });
}

std::optional<double> share_if_labels(const Volume& volume) {
    const Size& size = volume.grid().size;
    if (volume.type() == SampleType::float32) return {};
    if (volume.in_memory())
        return share_if_labels(size, *value_type_of(name_of(volume.type())), volume.data());
    return with_sample_type(volume.type(), [&](auto zero) {
        using T = decltype(zero);
        return measured<T>(size, [&](std::int64_t y, std::int64_t z) {
            return rows_around<T>(volume.store().source(), size, y, z);
        });
    });
}

Volume with_descriptions(const Volume& volume, std::vector<Label> described) {
    VolumeLabels labels;
    if (volume.labels()) labels = *volume.labels();
    for (Label& one : described) {
        one.code = std::strtod(one.number.c_str(), nullptr);
        const auto known = std::ranges::find(labels.list, one.number, &Label::number);
        if (known != labels.list.end()) {
            known->name = one.name;
            known->color = one.color;
        } else if (!labels.renumbered) {
            labels.list.push_back(std::move(one));
        }
    }
    std::ranges::sort(labels.list, {}, &Label::code);
    return volume.labelled(std::make_shared<const VolumeLabels>(std::move(labels)));
}

}  // namespace lamina
