// SPDX-License-Identifier: Apache-2.0
// Vector form of random_bits (compositing/random_bits.h), on vectors of 32-bit unsigned numbers.
#if defined(LAMINA_TILES_RANDOM_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_RANDOM_BITS_INL_H_
#undef LAMINA_TILES_RANDOM_BITS_INL_H_
#else
#define LAMINA_TILES_RANDOM_BITS_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class DU>
HWY_INLINE hn::Vec<DU> random_bits(DU d, hn::Vec<DU> column, hn::Vec<DU> row, hn::Vec<DU> sample,
                                   hn::Vec<DU> seed) {
    const auto spread = [d](hn::Vec<DU> v) {
        return hn::Add(hn::Mul(v, hn::Set(d, 1664525u)), hn::Set(d, 1013904223u));
    };
    auto x = spread(column), y = spread(row), z = spread(sample), w = spread(seed);
    const auto mix_all = [&] {
        x = hn::Add(x, hn::Mul(y, w));
        y = hn::Add(y, hn::Mul(z, x));
        z = hn::Add(z, hn::Mul(x, y));
        w = hn::Add(w, hn::Mul(y, z));
    };
    mix_all();
    x = hn::Xor(x, hn::ShiftRight<16>(x));
    y = hn::Xor(y, hn::ShiftRight<16>(y));
    z = hn::Xor(z, hn::ShiftRight<16>(z));
    w = hn::Xor(w, hn::ShiftRight<16>(w));
    mix_all();
    return w;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
