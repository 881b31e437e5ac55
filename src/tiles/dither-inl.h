// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/dither.h, bit for bit, on vectors of doubles.
#if defined(LAMINA_TILES_DITHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_DITHER_INL_H_
#undef LAMINA_TILES_DITHER_INL_H_
#else
#define LAMINA_TILES_DITHER_INL_H_
#endif

#include <hwy/highway.h>

#include "compositing/dither.h"
#include "tiles/codes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE hn::Vec<D> dither_code(D d, hn::Vec<D> scaled, double rank, int period, int increment,
                                  double largest) {
    const auto step = hn::Set(d, static_cast<double>(increment));
    const auto top = hn::Set(d, largest);
    const ScaledValues<hn::Vec<D>> value = split_scaled(d, hn::Div(scaled, step));
    const auto terms = hn::Floor(hn::Add(
        hn::Mul(hn::Set(d, static_cast<double>(period)), value.rest), hn::Set(d, code_noise)));
    const auto steps = step_up(d, value.whole, hn::Lt(hn::Set(d, rank), terms));
    const auto opaque = hn::Ge(scaled, hn::Set(d, largest - code_noise));
    return hn::IfThenElse(opaque, top, hn::Min(hn::Mul(steps, step), top));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
