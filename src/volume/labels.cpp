// SPDX-License-Identifier: Apache-2.0
#include "volume/labels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <mutex>
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
constexpr std::int64_t some_measured = std::int64_t{1} << 22, fewest_slices = 8;
constexpr std::int64_t rows_together = 256;  // of a slice, read and measured together

// How often a value occurs, and in how many pairs of neighbours, equal and different ones.
struct Tally {
    std::int64_t samples = 0, equal = 0, different = 0;
};

// The slices of a volume that are measured: all, or evenly spread ones.
struct MeasuredSlices {
    explicit MeasuredSlices(const Size& size) : of(size[2]), count(size[2]) {
        const std::int64_t slice = size[0] * size[1];
        if (slice * of > all_measured)
            count = std::min(of, std::max(fewest_slices, some_measured / slice));
    }
    std::int64_t at(std::int64_t number) const { return (2 * number + 1) * of / (2 * count); }

    std::int64_t of, count;
};

// Measures samples of type T. window(z, first, end) returns a SampleWindow that holds the rows from
// `first` to `end` - 1 of a slice, and all beside them.
template <typename T, typename Window>
class LabelMeasure {
  public:
    LabelMeasure(const Size& size, const Window& window)
        : size_(size), slices_(size), window_(window) {}

    std::optional<double> share() {
        for_bands([&](const auto&... band) { count_equal(band...); });
        const double measured = static_cast<double>(slices_.count * size_[0] * size_[1]);
        const double share = static_cast<double>(equal_six_) / measured;
        if (!whole_ || share < least_equal) return {};
        for_bands([&](const auto&... band) { tally(band...); });
        return has_few_values() && pairs_are_equal() ? std::optional(share) : std::nullopt;
    }

  private:
    // Calls part(z, first, end) for rows that make up all slices that are measured.
    template <typename Part>
    void for_bands(const Part& part) {
        const std::int64_t bands = (size_[1] + rows_together - 1) / rows_together;
        parallel_for(slices_.count * bands, 1, [&](std::int64_t i) {
            const std::int64_t first = i % bands * rows_together;
            part(slices_.at(i / bands), first, std::min(size_[1], first + rows_together));
        });
    }

    // Calls visit(row, rows beside it: before and after along y, then along z).
    template <typename Visit>
    void for_each_row(std::int64_t z, std::int64_t first, std::int64_t end,
                      const Visit& visit) const {
        const auto window = window_(z, first, end);
        for (std::int64_t y = first; y < end; ++y) {
            visit(window.row(y, z),
                  std::array<const T*, 4>{window.row(y - 1, z), window.row(y + 1, z),
                                          window.row(y, z - 1), window.row(y, z + 1)});
        }
    }

    void count_equal(std::int64_t z, std::int64_t first, std::int64_t end) {
        std::int64_t equal = 0;
        bool whole = true;
        for_each_row(z, first, end, [&](const T* row, const std::array<const T*, 4>& beside) {
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
    void tally(std::int64_t z, std::int64_t first, std::int64_t end) {
        std::unordered_map<T, Tally> found;
        for_each_row(z, first, end, [&](const T* row, const std::array<const T*, 4>& beside) {
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
    MeasuredSlices slices_;
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

// Rows of a volume in its files, and all beside them.
template <typename T>
struct ReadRows {
    ReadRows(const SampleSource& source, const Size& size, std::int64_t z, std::int64_t first,
             std::int64_t end) {
        SampleBox& box = window.box;
        const std::int64_t begins[] = {first, z}, ends[] = {end, z + 1};
        box.size[0] = size[0];
        for (std::size_t i = 0; i < 2; ++i) {
            box.first[i + 1] = std::max<std::int64_t>(begins[i] - 1, 0);
            box.size[i + 1] = std::min(ends[i] + 1, size[i + 1]) - box.first[i + 1];
        }
        samples.resize(static_cast<std::size_t>(box.count()));
        source.read(box, samples.data());
        window.samples = samples.data();
    }
    ReadRows(const ReadRows&) = delete;
    ReadRows& operator=(const ReadRows&) = delete;

    const T* row(std::int64_t y, std::int64_t z) const { return window.row(y, z); }

    std::vector<T> samples;
    SampleWindow<T> window;
};

}  // namespace

std::optional<double> share_if_labels(const Size& size, ValueType type, const void* samples) {
    return with_type(type, [&](auto zero) {
        using T = decltype(zero);
        const SampleWindow<T> whole{{{0, 0, 0}, size}, static_cast<const T*>(samples)};
        return measured<T>(size, [&](auto...) { return whole; });
    });
}

std::optional<double> share_if_labels(const Volume& volume) {
    const Size& size = volume.grid().size;
    if (volume.type() == SampleType::float32) return {};
    if (volume.in_memory())
        return share_if_labels(size, *value_type_of(name_of(volume.type())), volume.data());
    return with_sample_type(volume.type(), [&](auto zero) {
        using T = decltype(zero);
        return measured<T>(size, [&](auto... rows) {
            return ReadRows<T>(volume.store().source(), size, rows...);
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
