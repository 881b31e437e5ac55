// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lamina/volume.h"
#include "plan/plan.h"
#include "volume/sample_source.h"

namespace lamina {

// A gradient as lighting needs it: component * 2^exponent, in scalar units per world unit. Lengths
// have the range of double, so that sentinel values (1e36) beside a sample do not cost digits. The
// largest component has 15 bits, so each is off by at most 2^-15 of it.
struct StoredGradient {
    std::array<std::int16_t, 3> component{};
    std::int16_t exponent = no_exponent;

    static constexpr std::int16_t no_exponent = -0x4000;  // exponent of a gradient of 0

    friend bool operator==(const StoredGradient&, const StoredGradient&) = default;
};
static_assert(sizeof(StoredGradient) == 8);

StoredGradient store_gradient(const std::array<double, 3>& gradient);

// Sets the gradients at the samples of row (y, z) of a plan's brick (docs/numerics.md, section 10),
// along the grid's orthogonal axes; lights are rotated into these. `row`: part.size[0] gradients.
void set_gradient_row(const Volume& volume, const TextureBrick& part, std::int64_t y,
                      std::int64_t z, std::span<StoredGradient> row);

// Sets the gradients of a page, a brick of BrickCache: BrickCache::samples along each axis from
// `first` on. `window` must hold one sample more on each side, if the volume has one.
template <typename Sample>
void set_page_gradients(const Grid& grid, const SampleWindow<Sample>& window,
                        const std::array<std::int64_t, 3>& first, StoredGradient* to);

// Returns the gradients at all samples of a brick of the plan, x fastest.
std::vector<StoredGradient> make_gradient_map(const Volume& volume, const TextureBrick& part);

}  // namespace lamina
