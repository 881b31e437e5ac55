// SPDX-License-Identifier: Apache-2.0
// The vectors that the native renderers compute with: one number for each pixel of a block.
#if defined(LAMINA_EXECUTORS_TILE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_EXECUTORS_TILE_VECTORS_INL_H_
#undef LAMINA_EXECUTORS_TILE_VECTORS_INL_H_
#else
#define LAMINA_EXECUTORS_TILE_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include "tiles/doubles-inl.h"
#include "tiles/tile_grid.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t most_lanes = TileGrid::block * TileGrid::block;

using FloatTag = hn::CappedTag<float, most_lanes>;
using IntTag = hn::RebindToSigned<FloatTag>;
using WordTag = hn::RebindToUnsigned<FloatTag>;
using DoubleTag = hn::Repartition<double, FloatTag>;

using Floats = hn::Vec<FloatTag>;
using FloatMask = hn::Mask<FloatTag>;
using Ints = hn::Vec<IntTag>;
using Words = hn::Vec<WordTag>;
// A vector of floats corresponds to two vectors of doubles.
using HalfDoubles = hn::Vec<DoubleTag>;
using TwoDoubles = Doubles<FloatTag>;

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
