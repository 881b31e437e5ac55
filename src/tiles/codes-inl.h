// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/codes.h, bit for bit, on vectors of doubles: codes are whole numbers.
#if defined(LAMINA_TILES_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_CODES_INL_H_
#undef LAMINA_TILES_CODES_INL_H_
#else
#define LAMINA_TILES_CODES_INL_H_
#endif

#include <hwy/highway.h>

#include "base/unreachable.h"
#include "compositing/codes.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct ScaledValues {
    V whole, rest;
};

template <class D>
HWY_INLINE ScaledValues<hn::Vec<D>> split_scaled(D d, hn::Vec<D> scaled) {
    const auto whole = hn::Floor(hn::Add(scaled, hn::Set(d, code_noise)));
    return {whole, hn::Max(hn::Sub(scaled, whole), hn::Zero(d))};
}

template <class D>
HWY_INLINE hn::Vec<D> code_nearest(D d, hn::Vec<D> scaled) {
    return hn::Floor(hn::Add(scaled, hn::Set(d, 0.5)));
}

// `code`, or the next code where `up`.
template <class D>
HWY_INLINE hn::Vec<D> step_up(D d, hn::Vec<D> code, hn::Mask<D> up) {
    return hn::Add(code, hn::IfThenElseZero(up, hn::Set(d, 1.0)));
}

// `random`: 32 random bits as a number, for stochastic rounding only.
template <class D>
HWY_INLINE hn::Vec<D> round_alpha(D d, AlphaRounding rounding,
                                  const ScaledValues<hn::Vec<D>>& scaled, hn::Vec<D> random) {
    switch (rounding) {
        case AlphaRounding::truncate:
            return scaled.whole;
        case AlphaRounding::nearest:
            return step_up(d, scaled.whole,
                           hn::Ge(hn::Add(scaled.rest, hn::Set(d, code_noise)), hn::Set(d, 0.5)));
        case AlphaRounding::stochastic:
            return step_up(d, scaled.whole,
                           hn::Lt(random, hn::Mul(scaled.rest, hn::Set(d, 0x1p32))));
    }
    unreachable_enum();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
