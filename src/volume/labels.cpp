// SPDX-License-Identifier: Apache-2.0
#include "volume/labels.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/content_hash.h"
#include "base/parallel.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

using Size = std::array<std::int64_t, 3>;

// Shares that labels have at least, and that a rounded field has at least. Eight atlases have 60 to
// 100 % of values with an inside, and up to 40 % of steps by 1; nested shells have 71 %. CTs and
// blurred edges have 4 %, and rounded fields with half of such values 99 % (docs/journal.md).
constexpr double least_equal = .95, least_with_inside = .5, least_by_one = .9;
constexpr std::size_t most_nested = 4;  // values; so few may be nested structures
// Share of equal samples, and number of samples, from and up to which a message names the signs
// that labels cut out of larger volumes have; and the share from which it does of larger volumes,
// too, where counting costs more: few pictures reach it.
constexpr double least_scattered = .5, nearly_equal = .9;
constexpr std::int64_t most_scattered = std::int64_t{1} << 21;
constexpr std::int64_t all_measured = std::int64_t{1} << 24;  // samples
constexpr std::int64_t some_measured = std::int64_t{1} << 22, fewest_slices = 8;
constexpr std::int64_t rows_together = 256;  // of a slice, read and measured together

// In how many pairs of neighbours a value is, equal and different ones. Pairs with the most
// frequent value are left out.
struct Tally {
    std::int64_t equal = 0, different = 0;
};

template <typename T>
bool differ_by_one(T a, T b) {
    const T less = std::min(a, b), more = std::max(a, b);  // less + 1 does not overflow
    return static_cast<T>(less + 1) == more;
}

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

    LabelSigns signs() {
        for_bands([&](const auto&... band) { count_equal(band...); });
        const std::int64_t measured = slices_.count * size_[0] * size_[1];
        LabelSigns found;
        found.equal = static_cast<double>(equal_six_) / static_cast<double>(measured);
        const bool scattered = found.equal < least_equal;
        const double least = measured > most_scattered ? nearly_equal : least_scattered;
        if (!whole_ || (scattered && found.equal < least)) return found;
        for_bands([&](const auto&... band) { count_values(band...); });
        if (samples_.size() < 2 || samples_.size() > most_label_codes) return found;
        // The least of several.
        const auto rarer = [](const auto& a, const auto& b) {
            return std::pair(a.second, b.first) < std::pair(b.second, a.first);
        };
        common_ = std::ranges::max_element(samples_, rarer)->first;
        for_bands([&](const auto&... band) { tally(band...); });
        if (!have_insides()) return found;
        if (different_ > 0)  // else they meet between the slices that are measured
            found.by_one = static_cast<double>(by_one_) / static_cast<double>(different_);
        found.verdict = verdict_of(found, scattered);
        return found;
    }

  private:
    using Verdict = LabelSigns::Verdict;

    Verdict verdict_of(const LabelSigns& found, bool scattered) const {
        if (samples_.size() > most_nested && found.by_one >= least_by_one)
            return scattered ? Verdict::none : Verdict::smooth;
        return scattered ? Verdict::scattered : Verdict::labels;
    }

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

    void count_values(std::int64_t z, std::int64_t first, std::int64_t end) {
        std::unordered_map<T, std::int64_t> found;
        for_each_row(z, first, end, [&](const T* row, const auto& /*beside*/) {
            std::int64_t* current = nullptr;
            for (std::int64_t x = 0; x < size_[0]; ++x) {
                if (x == 0 || row[x] != row[x - 1]) current = &found[row[x]];
                ++*current;
            }
        });
        const std::lock_guard lock(merging_);
        if (samples_.size() > most_label_codes) return;
        for (const auto& [value, count] : found) samples_[value] += count;
    }

    // Counts pairs of a sample and its next neighbour along each axis.
    void tally(std::int64_t z, std::int64_t first, std::int64_t end) {
        std::unordered_map<T, Tally> found;
        std::int64_t by_one = 0, different = 0;
        const auto add_unequal = [&](Tally& tally, T value, T next) {
            ++different;
            by_one += differ_by_one(value, next) ? 1 : 0;
            if (value == common_ || next == common_) return;
            ++tally.different;
            ++found[next].different;
        };
        for_each_row(z, first, end, [&](const T* row, const std::array<const T*, 4>& beside) {
            Tally* current = nullptr;
            for (std::int64_t x = 0; x < size_[0]; ++x) {
                const T value = row[x];
                if (x == 0 || value != row[x - 1]) current = &found[value];
                const auto add = [&](T next) {
                    if (next == value)
                        ++current->equal;
                    else
                        add_unequal(*current, value, next);
                };
                // A row at the border is its own neighbour, which makes no pair.
                if (x + 1 < size_[0]) add(row[x + 1]);
                if (beside[1] != row) add(beside[1][x]);
                if (beside[3] != row) add(beside[3][x]);
            }
        });
        const std::lock_guard lock(merging_);
        for (const auto& [value, one] : found) {
            tallies_[value].equal += one.equal;
            tallies_[value].different += one.different;
        }
        by_one_ += by_one;
        different_ += different;
    }

    // Tells if most values have an inside. Single samples in the most frequent value do not count.
    bool have_insides() const {
        std::int64_t all = 0, with_inside = 0;
        for (const auto& [value, one] : tallies_) {
            if (value == common_ || one.equal + one.different == 0) continue;
            ++all;
            with_inside += 2 * one.equal >= one.different ? 1 : 0;
        }
        return all > 0 &&
               static_cast<double>(with_inside) >= least_with_inside * static_cast<double>(all);
    }

    Size size_;
    MeasuredSlices slices_;
    const Window& window_;
    std::mutex merging_;
    std::int64_t equal_six_ = 0;
    bool whole_ = true;
    std::unordered_map<T, std::int64_t> samples_;  // of each value
    T common_{};                                   // the most frequent value
    std::unordered_map<T, Tally> tallies_;
    std::int64_t by_one_ = 0, different_ = 0;  // pairs of unequal neighbours
};

template <typename T, typename Window>
LabelSigns measured(const Size& size, const Window& window) {
    return LabelMeasure<T, Window>(size, window).signs();
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

LabelSigns label_signs(const Size& size, ValueType type, const void* samples) {
    return with_type(type, [&](auto zero) {
        using T = decltype(zero);
        const SampleWindow<T> whole{{{0, 0, 0}, size}, static_cast<const T*>(samples)};
        return measured<T>(size, [&](auto...) { return whole; });
    });
}

LabelSigns label_signs(const Volume& volume) {
    const Size& size = volume.grid().size;
    if (volume.type() == SampleType::float32) return {};
    if (volume.in_memory())
        return label_signs(size, *value_type_of(name_of(volume.type())), volume.data());
    return with_sample_type(volume.type(), [&](auto zero) {
        using T = decltype(zero);
        return measured<T>(size, [&](auto... rows) {
            return ReadRows<T>(volume.store().source(), size, rows...);
        });
    });
}

std::string identity_of_codes(const Volume& volume) {
    if (!volume.labels() || !volume.labels()->renumbered) return {};
    ContentHash hash;
    for (const Label& label : volume.labels()->list) hash.add(label.number);
    return hash.hex();
}

Volume with_descriptions(const Volume& volume, std::vector<Label> described) {
    VolumeLabels labels;
    if (volume.labels()) labels = *volume.labels();
    std::unordered_map<std::string, std::size_t> places;  // in the list, by number
    for (const Label& known : labels.list) places.emplace(known.number, places.size());
    for (Label& one : described) {
        one.code = std::strtod(one.number.c_str(), nullptr);
        if (const auto place = places.find(one.number); place != places.end()) {
            Label& known = labels.list[place->second];
            one.code = known.code;
            known = std::move(one);
        } else if (!labels.renumbered) {
            places.emplace(one.number, labels.list.size());
            labels.list.push_back(std::move(one));
        }
    }
    std::ranges::sort(labels.list, {}, &Label::code);
    return volume.labelled(std::make_shared<const VolumeLabels>(std::move(labels)));
}

}  // namespace lamina
