// SPDX-License-Identifier: Apache-2.0
// Elementary functions of vectors of floats. As everywhere in this room, every product and every
// sum is rounded by itself, so that all instruction sets compute the same numbers (unless they are
// built with LAMINA_FMA).
#if defined(LAMINA_TILES_ARITHMETIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_ARITHMETIC_INL_H_
#undef LAMINA_TILES_ARITHMETIC_INL_H_
#else
#define LAMINA_TILES_ARITHMETIC_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
HWY_INLINE V mul_add(V a, V b, V c) {
    return hn::Add(hn::Mul(a, b), c);
}

// a + share * (b - a)
template <class V>
HWY_INLINE V mix(V a, V b, V share) {
    return hn::Add(a, hn::Mul(share, hn::Sub(b, a)));
}

template <class D>
HWY_INLINE hn::Vec<D> clamp01(D d, hn::Vec<D> v) {
    return hn::Min(hn::Max(v, hn::Zero(d)), hn::Set(d, 1.0f));
}

// c[0] + x * (c[1] + x * (c[2] + ...))
template <class D, std::size_t count>
HWY_INLINE hn::Vec<D> polynomial(D d, hn::Vec<D> x, const float (&c)[count]) {
    hn::Vec<D> sum = hn::Set(d, c[count - 1]);
    for (std::size_t i = count - 1; i-- > 0;) sum = mul_add(sum, x, hn::Set(d, c[i]));
    return sum;
}

// 2^n for whole n from -126 to 127.
template <class D>
HWY_INLINE hn::Vec<D> power_of_two(D d, hn::Vec<hn::RebindToSigned<D>> n) {
    const hn::RebindToSigned<D> di;
    return hn::BitCast(d, hn::ShiftLeft<23>(hn::Add(n, hn::Set(di, 127))));
}

// exp(x) with a relative error of 2e-7 where |x| < 87; 1e-38 below and 2e38 above.
template <class D>
HWY_INLINE hn::Vec<D> exp_of(D d, hn::Vec<D> x) {
    const auto inside = hn::Min(hn::Max(x, hn::Set(d, -87.3f)), hn::Set(d, 88.3f));
    const auto n = hn::NearestInt(hn::Mul(inside, hn::Set(d, 1.44269504f)));
    const auto whole = hn::ConvertTo(d, n);
    // log(2) is split into two numbers, the first with few digits (Cody, Waite 1980).
    auto f = hn::Sub(inside, hn::Mul(whole, hn::Set(d, 0.693359375f)));
    f = hn::Sub(f, hn::Mul(whole, hn::Set(d, -2.12194440e-4f)));
    // A polynomial of degree 6. Its last five terms interpolate (exp(f) - 1 - f) / f^2 at
    // Chebyshev's nodes, to 1e-8.
    constexpr float series[] = {1.0f,          1.0f,           0.5f,          0.166665768f,
                                0.0416665544f, 8.36320297e-3f, 1.39262135e-3f};
    // Applied in two steps, because 2^n itself may not be a normal number.
    const auto half = hn::ShiftRight<1>(n);
    return hn::Mul(hn::Mul(polynomial(d, f, series), power_of_two(d, half)),
                   power_of_two(d, hn::Sub(n, half)));
}

// log(x) for x >= 1e-37, with a relative error of 2e-7, except near 1, where the absolute error is
// 6e-8.
template <class D>
HWY_INLINE hn::Vec<D> log_of(D d, hn::Vec<D> x) {
    const hn::RebindToSigned<D> di;
    // x = 2^n m with sqrt(1/2) <= m < sqrt(2); log(m) = 2 artanh((m - 1) / (m + 1)).
    const auto bits = hn::BitCast(di, x);
    const auto n = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));
    const auto m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(n)));
    const auto one = hn::Set(d, 1.0f);
    const auto z = hn::Div(hn::Sub(m, one), hn::Add(m, one));
    constexpr float series[] = {2.0f, 0.666666667f, 0.4f, 0.285714286f, 0.222222222f};
    const auto whole = hn::ConvertTo(d, n);
    const auto log_m = hn::Mul(z, polynomial(d, hn::Mul(z, z), series));
    return mul_add(whole, hn::Set(d, 0.693359375f),
                   hn::Add(log_m, hn::Mul(whole, hn::Set(d, -2.12194440e-4f))));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
