// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "lamina/volume.h"
#include "volume/volume_store.h"
#include "volume/with_sample_type.h"

namespace lamina {

// Samples of a volume that stays in its files, one by one, as a pointer to the first would give
// them: x changes fastest.
template <typename T>
class SamplesInFiles {
  public:
    SamplesInFiles() = default;  // of no volume
    explicit SamplesInFiles(const VolumeStore& store, std::int64_t first = 0)
        : store_(&store), first_(first) {}

    T operator[](std::int64_t number) const {
        number += first_;
        const auto& size = store_->size();
        return store_->template sample<T>(number % size[0], number / size[0] % size[1],
                                          number / (size[0] * size[1]));
    }
    // The samples at the corners of a cell, x fastest, which is at most one step wide on each axis.
    std::array<T, 8> corners(const std::array<std::int64_t, 3>& lower,
                             const std::array<std::int64_t, 3>& upper) const {
        return store_->template corners<T>(lower, upper);
    }
    friend SamplesInFiles operator+(const SamplesInFiles& samples, std::int64_t steps) {
        return SamplesInFiles(*samples.store_, samples.first_ + steps);
    }

  private:
    const VolumeStore* store_ = nullptr;
    std::int64_t first_ = 0;
};

// The type of the samples behind a pointer or SamplesInFiles.
template <typename Samples>
using SampleOf = std::remove_cvref_t<decltype(std::declval<const Samples&>()[0])>;

// Calls visitor(samples) with a pointer to the first sample, or with SamplesInFiles: for work that
// looks at single samples here and there.
template <typename Visitor>
decltype(auto) visit_samples(const Volume& volume, const Visitor& visitor) {
    if (volume.in_memory()) return volume.visit(visitor);
    return with_sample_type(volume.type(), [&](auto zero) {
        return visitor(SamplesInFiles<decltype(zero)>(volume.store()));
    });
}

// Throws Error where the files of a volume that stays in them have changed since it was opened.
inline void check_unchanged(const Volume& volume) {
    if (!volume.in_memory()) volume.store().source().check_unchanged();
}

}  // namespace lamina
