// SPDX-License-Identifier: Apache-2.0
// Vector form of compositing/node_code.h on vectors of floats, as
// shaders/compositing/node_code.glsl computes it.
#if defined(LAMINA_TILES_NODE_CODE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_TILES_NODE_CODE_INL_H_
#undef LAMINA_TILES_NODE_CODE_INL_H_
#else
#define LAMINA_TILES_NODE_CODE_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <numbers>

#include "base/unreachable.h"
#include "compositing/node_code.h"
#include "tiles/arithmetic-inl.h"
#include "tiles/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr float inverse_e = static_cast<float>(1 / std::numbers::e);

// log(1 / share) / e, for NodeCode::minimax.
HWY_INLINE float log_part_of(float share) {
    return static_cast<float>(-std::log(static_cast<double>(share)) / std::numbers::e);
}

// -log(1 - value), 0 <= value < 1. Below 1/4 it is 2 artanh(value / (2 - value)), because 1 - value
// loses digits of small values. The first omitted term is 2e-8 of the result.
template <class D>
HWY_INLINE hn::Vec<D> depth_from_opacity(D d, hn::Vec<D> value) {
    const auto z = hn::Div(value, hn::Sub(hn::Set(d, 2.0f), value));
    constexpr float series[] = {2.0f, 2.0f / 3, 2.0f / 5, 2.0f / 7};
    const auto small = hn::Mul(z, polynomial(d, hn::Mul(z, z), series));
    const auto large = hn::Neg(log_of(d, hn::Sub(hn::Set(d, 1.0f), value)));
    return hn::IfThenElse(hn::Lt(value, hn::Set(d, 0.25f)), small, large);
}

template <class D>
HWY_INLINE hn::Vec<D> encode_minimax(D d, hn::Vec<D> depth, float share) {
    const auto one = hn::Set(d, 1.0f);
    const auto sigma = hn::Div(depth, hn::Set(d, share));
    const float log_part = log_part_of(share);
    const auto middle =
        mul_add(log_of(d, sigma), hn::Set(d, inverse_e), hn::Set(d, 1.0f - inverse_e));
    const auto last = hn::Sub(hn::Set(d, 1.0f + log_part), exp_of(d, hn::Neg(depth)));
    auto scaled = hn::IfThenElse(hn::Gt(sigma, one), middle, opacity_from_depth(d, sigma));
    scaled = hn::IfThenElse(hn::Gt(depth, one), last, scaled);
    return hn::Min(hn::Div(scaled, hn::Set(d, 1.0f + log_part)), one);
}

template <class D>
HWY_INLINE hn::Vec<D> decode_minimax(D d, hn::Vec<D> value, float share) {
    const auto one = hn::Set(d, 1.0f);
    const float log_part = log_part_of(share);
    const auto u = hn::Mul(value, hn::Set(d, 1.0f + log_part));
    const auto low = hn::Mul(hn::Set(d, share), depth_from_opacity(d, u));
    const auto exponent = mul_add(hn::Sub(u, one), hn::Set(d, std::numbers::e_v<float>), one);
    const auto middle = hn::Mul(hn::Set(d, share), exp_of(d, exponent));
    const auto rest = hn::Sub(hn::Set(d, 1.0f + log_part), u);  // exp(-depth)
    const auto high = hn::IfThenElse(hn::Gt(rest, hn::Zero(d)), hn::Neg(log_of(d, rest)),
                                     hn::Set(d, static_cast<float>(opaque_node_depth)));
    const auto depth =
        hn::IfThenElse(hn::Le(u, hn::Set(d, 1.0f - inverse_e + log_part)), middle, high);
    return hn::IfThenElse(hn::Le(u, hn::Set(d, 1.0f - inverse_e)), low, depth);
}

template <class D>
HWY_INLINE hn::Vec<D> encode_depth(D d, NodeCode code, hn::Vec<D> depth, float share) {
    switch (code) {
        case NodeCode::phi:
            return opacity_from_depth(d, hn::Div(depth, hn::Set(d, share)));
        case NodeCode::alpha:
            return opacity_from_depth(d, depth);
        case NodeCode::minimax:
            return encode_minimax(d, depth, share);
    }
    unreachable_enum();
}

template <class D>
HWY_INLINE hn::Vec<D> decode_depth(D d, NodeCode code, hn::Vec<D> value, float share) {
    const auto opaque = hn::Set(d, static_cast<float>(opaque_node_depth));
    auto depth = opaque;
    switch (code) {
        case NodeCode::phi:
            depth = hn::Mul(hn::Set(d, share), depth_from_opacity(d, value));
            break;
        case NodeCode::alpha:
            depth = depth_from_opacity(d, value);
            break;
        case NodeCode::minimax:
            depth = decode_minimax(d, value, share);
            break;
    }
    return hn::IfThenElse(hn::Ge(value, hn::Set(d, 1.0f)), opaque, hn::Min(depth, opaque));
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
