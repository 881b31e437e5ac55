// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/stochastic_over.h, bit for bit, on vectors of doubles.
#if defined(LAMINA_TILES_STOCHASTIC_OVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_STOCHASTIC_OVER_INL_H_
#undef LAMINA_TILES_STOCHASTIC_OVER_INL_H_
#else
#define LAMINA_TILES_STOCHASTIC_OVER_INL_H_
#endif

#include <hwy/highway.h>

#include "tiles/codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// `random`: 32 random bits as a number.
template <class D>
HWY_INLINE hn::Vec<D> over_stochastic(D d, hn::Vec<D> source, hn::Vec<D> alpha, hn::Vec<D> below,
                                      hn::Vec<D> random, double largest) {
    const auto top = hn::Set(d, largest);
    const auto kept = hn::Mul(below, hn::Sub(hn::Set(d, 1.0), alpha));
    const ScaledValues<hn::Vec<D>> value = split_scaled(d, hn::Add(hn::Mul(top, source), kept));
    const auto up = hn::Lt(random, hn::Mul(value.rest, hn::Set(d, 0x1p32)));
    return hn::Min(step_up(d, value.whole, up), top);
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
