// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_volume.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "base/memory.h"
#include "base/parallel.h"
#include "facts/drawn_range.h"
#include "slicing/texture_bricks.h"

namespace lamina {
namespace {

std::int64_t samples_of(const TextureBrick& part) {
    return part.size[0] * part.size[1] * part.size[2];
}

// Calls visit(y, z), for all rows, in parallel.
template <typename Visit>
void for_each_row(const TextureBrick& part, const Visit& visit) {
    parallel_for(part.size[1] * part.size[2], 64,
                 [&](std::int64_t number) { visit(number % part.size[1], number / part.size[1]); });
}

}  // namespace

TileVolume::TileVolume(const Volume& volume, const ValueRange& range, const SlicePlan& plan)
    : volume_(volume),
      range_(range),
      parts_(plan.bricks),
      float_texture_(plan.float_texture),
      lit_(plan.lighting.has_value()) {
    const bool whole = plan.bricks.size() == 1;
    for (const TextureBrick& part : plan.bricks) {
        TileBrick brick;
        brick.layout = plan.float_texture                   ? TileLayout::floats
                       : volume.type() != SampleType::uint8 ? TileLayout::words
                                                            : TileLayout::bytes;
        for (std::size_t axis = 0; axis < 3; ++axis)
            brick.last_sample[axis] = static_cast<float>(part.size[axis] - 1);
        brick.row = part.size[1] > 1 ? static_cast<std::int32_t>(part.size[0]) : 0;
        brick.slice = part.size[2] > 1 ? static_cast<std::int32_t>(part.size[0] * part.size[1]) : 0;
        normalise(range, brick);
        if (!volume.in_memory()) {
            bricks_.push_back(brick);
            continue;
        }
        if (whole && brick.layout != TileLayout::floats && volume.byte_count() >= 4) {
            refer_to_volume(brick);
        } else {
            copy_brick(part, brick);
        }
        if (lit_) {
            gradients_.push_back(make_gradient_map(volume, part));
            brick.gradients = gradients_.back().data();
        }
        bricks_.push_back(brick);
    }
    if (!volume.in_memory()) page();
}

// Normalises as OpenGL reads codes: code / largest, int16 from 0 on.
void TileVolume::normalise(const ValueRange& range, TileBrick& brick) const {
    if (brick.layout == TileLayout::floats) return;
    const double largest = volume_.type() == SampleType::uint8 ? 255 : 65535;
    const double shift = volume_.type() == SampleType::int16 ? 32768 : 0;
    const double scale = 1 / (range.hi - range.lo);
    brick.flip = volume_.type() == SampleType::int16 ? 0x80008000u : 0u;
    brick.scale = static_cast<float>(scale);
    brick.offset = static_cast<float>(-(range.lo + shift) * scale);
    brick.unit = static_cast<float>(1 / largest);
    brick.unit_scale = static_cast<float>(largest * scale);
}

void TileVolume::refer_to_volume(TileBrick& brick) {
    brick.samples = volume_.data();
    brick.last_word = static_cast<std::int32_t>(volume_.byte_count() - 4);
}

void TileVolume::copy_brick(const TextureBrick& part, TileBrick& brick) {
    const Grid& grid = volume_.grid();
    const std::int64_t count = samples_of(part);
    const std::int64_t bytes = brick.layout == TileLayout::bytes   ? count
                               : brick.layout == TileLayout::words ? 2 * count
                                                                   : 4 * count;
    const std::int64_t words = (bytes + 3) / 4;
    auto* const copy = static_cast<std::uint32_t*>(
        copies_.emplace_back(filled_memory(4 * static_cast<std::size_t>(words))).get());
    copy[words - 1] = 0;  // rows may end before it does
    copied_bytes_ += 4 * words;
    brick.samples = copy;
    brick.last_word = static_cast<std::int32_t>(
        std::min<std::int64_t>(4 * words - 4, std::numeric_limits<std::int32_t>::max()));
    volume_.visit([&](const auto* samples) {
        using Sample = std::remove_cvref_t<decltype(*samples)>;
        for_each_row(part, [&](std::int64_t y, std::int64_t z) {
            const BrickRow own = row_of(part, grid, y, z);
            const Sample* const row = samples + own.first;
            const std::int64_t place = (z * part.size[1] + y) * part.size[0];
            if (brick.layout != TileLayout::floats) {
                std::memcpy(reinterpret_cast<std::byte*>(copy) +
                                static_cast<std::size_t>(place) * sizeof(Sample),
                            row, static_cast<std::size_t>(part.size[0]) * sizeof(Sample));
                return;
            }
            for (std::int64_t x = own.begin; x < own.end; ++x) {
                copy[place + x] =
                    std::bit_cast<std::uint32_t>(normalised_sample(row[x - own.begin], range_));
            }
            own.repeat_ends(copy + place, part.size[0]);
        });
    });
}

bool TileVolume::serves(const Volume& volume, const ValueRange& range,
                        const SlicePlan& plan) const {
    return volume.shares_samples(volume_) && range == range_ && plan.bricks == parts_ &&
           plan.float_texture == float_texture_ && plan.lighting.has_value() == lit_;
}

std::int64_t TileVolume::byte_count() const {
    std::int64_t bytes = copied_bytes_;
    for (const auto& map : gradients_)
        bytes += static_cast<std::int64_t>(sizeof(StoredGradient) * map.size());
    if (cache_ != nullptr) bytes += static_cast<std::int64_t>(cache_->resident_bytes());
    return bytes;
}

}  // namespace lamina
