// SPDX-License-Identifier: Apache-2.0
// Types and functions of code that computes with SIMD vectors, written like code for single
// numbers. Float, Int and Word have one lane for each pixel of a block of pixels, or of some of its
// rows. Double and Long have half as many lanes, of twice the size. Float64 is two Doubles, with as
// many lanes as Float. A scalar stands for all lanes: `0.5f * a`. Every operation is rounded by
// itself, so that all instruction sets compute the same numbers; only fma(), fms() and fnma() are
// fused, if the instruction set can.
#if defined(LAMINA_SIMD_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_SIMD_VECTORS_INL_H_
#undef LAMINA_SIMD_VECTORS_INL_H_
#else
#define LAMINA_SIMD_VECTORS_INL_H_
#endif

#include <hwy/highway.h>
#include <algorithm>
#include <cmath>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "simd/target.h"

LAMINA_SIMD_BEGIN

namespace hn = hwy::HWY_NAMESPACE;

// Largest number of lanes of a Float. HWY_MAX_BYTES allows no more on any instruction set.
inline constexpr std::size_t most_lanes = 16;

// A truth value in each lane, for vectors whose lanes have the size of `Tag`'s.
template <class Tag>
struct MaskOf {
    hn::Mask<Tag> m;

    MaskOf() = default;
    LAMINA_INLINE MaskOf(hn::Mask<Tag> lanes) : m(lanes) {}
    LAMINA_INLINE explicit MaskOf(bool all)
        : m(hn::FirstN(Tag(), all ? hn::Lanes(Tag()) : std::size_t{0})) {}

    friend LAMINA_INLINE MaskOf operator&(MaskOf a, MaskOf b) { return hn::And(a.m, b.m); }
    friend LAMINA_INLINE MaskOf operator|(MaskOf a, MaskOf b) { return hn::Or(a.m, b.m); }
    friend LAMINA_INLINE MaskOf operator^(MaskOf a, MaskOf b) { return hn::Xor(a.m, b.m); }
    friend LAMINA_INLINE MaskOf operator!(MaskOf a) { return hn::Not(a.m); }
    // Returns the lanes of `a` that are not in `b`.
    friend LAMINA_INLINE MaskOf without(MaskOf a, MaskOf b) { return hn::AndNot(b.m, a.m); }

    friend LAMINA_INLINE bool any_of(MaskOf a) { return !hn::AllFalse(Tag(), a.m); }
    friend LAMINA_INLINE bool all_of(MaskOf a) { return hn::AllTrue(Tag(), a.m); }
    friend LAMINA_INLINE bool none_of(MaskOf a) { return hn::AllFalse(Tag(), a.m); }
    friend LAMINA_INLINE std::size_t count_of(MaskOf a) { return hn::CountTrue(Tag(), a.m); }
    // Returns a bit for each lane, the first lane lowest.
    friend LAMINA_INLINE std::uint32_t bits_of(MaskOf a) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(Tag(), a.m, bytes);
        return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
    }
};

template <class Mask>
struct TagOfMask;
template <class Tag>
struct TagOfMask<MaskOf<Tag>> {
    using Type = Tag;
};

template <class Mask>
LAMINA_INLINE Mask mask_of_bits(std::uint32_t bits) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                   static_cast<std::uint8_t>(bits >> 8)};
    return hn::LoadMaskBits(typename TagOfMask<Mask>::Type(), bytes);
}

// Returns the mask of the first `count` lanes, or of all if there are fewer.
template <class Mask>
LAMINA_INLINE Mask first_lanes(std::size_t count) {
    return hn::FirstN(typename TagOfMask<Mask>::Type(), count);
}

template <class D>
struct Vector {
    using Tag = D;
    using Scalar = hn::TFromD<D>;
    // Floats and integers of one size have the same kind of mask.
    using MaskTag = hn::Rebind<std::conditional_t<sizeof(Scalar) == 8, double, float>, D>;
    using Mask = MaskOf<MaskTag>;
    static constexpr std::size_t lanes = hn::MaxLanes(D());

    hn::Vec<D> v;

    Vector() = default;
    LAMINA_INLINE Vector(hn::Vec<D> each) : v(each) {}
    LAMINA_INLINE Vector(Scalar all) : v(hn::Set(D(), all)) {}

    friend LAMINA_INLINE Vector operator+(Vector a, Vector b) { return hn::Add(a.v, b.v); }
    friend LAMINA_INLINE Vector operator-(Vector a, Vector b) { return hn::Sub(a.v, b.v); }
    friend LAMINA_INLINE Vector operator*(Vector a, Vector b) { return hn::Mul(a.v, b.v); }
    friend LAMINA_INLINE Vector operator/(Vector a, Vector b) { return hn::Div(a.v, b.v); }
    friend LAMINA_INLINE Vector operator-(Vector a) { return hn::Neg(a.v); }
    friend LAMINA_INLINE Vector& operator+=(Vector& a, Vector b) { return a = a + b; }
    friend LAMINA_INLINE Vector& operator-=(Vector& a, Vector b) { return a = a - b; }
    friend LAMINA_INLINE Vector& operator*=(Vector& a, Vector b) { return a = a * b; }

    friend LAMINA_INLINE Vector operator&(Vector a, Vector b) { return hn::And(a.v, b.v); }
    friend LAMINA_INLINE Vector operator|(Vector a, Vector b) { return hn::Or(a.v, b.v); }
    friend LAMINA_INLINE Vector operator^(Vector a, Vector b) { return hn::Xor(a.v, b.v); }
    // Returns the bits of `a` that are not set in `b`.
    friend LAMINA_INLINE Vector without(Vector a, Vector b) { return hn::AndNot(b.v, a.v); }

    friend LAMINA_INLINE Mask operator<(Vector a, Vector b) { return mask(hn::Lt(a.v, b.v)); }
    friend LAMINA_INLINE Mask operator>(Vector a, Vector b) { return mask(hn::Gt(a.v, b.v)); }
    friend LAMINA_INLINE Mask operator<=(Vector a, Vector b) { return mask(hn::Le(a.v, b.v)); }
    friend LAMINA_INLINE Mask operator>=(Vector a, Vector b) { return mask(hn::Ge(a.v, b.v)); }
    friend LAMINA_INLINE Mask operator==(Vector a, Vector b) { return mask(hn::Eq(a.v, b.v)); }
    friend LAMINA_INLINE Mask operator!=(Vector a, Vector b) { return mask(hn::Ne(a.v, b.v)); }

    friend LAMINA_INLINE Vector min(Vector a, Vector b) { return hn::Min(a.v, b.v); }
    friend LAMINA_INLINE Vector max(Vector a, Vector b) { return hn::Max(a.v, b.v); }
    friend LAMINA_INLINE Vector clamp(Vector a, Vector least, Vector most) {
        return hn::Min(hn::Max(a.v, least.v), most.v);
    }
    friend LAMINA_INLINE Vector abs(Vector a) { return hn::Abs(a.v); }
    friend LAMINA_INLINE Vector sqrt(Vector a) { return hn::Sqrt(a.v); }
    friend LAMINA_INLINE Vector floor(Vector a) { return hn::Floor(a.v); }
    friend LAMINA_INLINE Vector ceil(Vector a) { return hn::Ceil(a.v); }
    friend LAMINA_INLINE Vector trunc(Vector a) { return hn::Trunc(a.v); }
    // Returns the nearest whole number; of two, the even one.
    friend LAMINA_INLINE Vector round(Vector a) { return hn::Round(a.v); }
    friend LAMINA_INLINE Vector copy_sign(Vector a, Vector sign) {
        return hn::CopySign(a.v, sign.v);
    }
    friend LAMINA_INLINE Mask is_finite(Vector a) { return mask(hn::IsFinite(a.v)); }

    // Return a * b + c, a * b - c and c - a * b, rounded once if possible, else twice.
    friend LAMINA_INLINE Vector fma(Vector a, Vector b, Vector c) {
        return hn::MulAdd(a.v, b.v, c.v);
    }
    friend LAMINA_INLINE Vector fms(Vector a, Vector b, Vector c) {
        return hn::MulSub(a.v, b.v, c.v);
    }
    friend LAMINA_INLINE Vector fnma(Vector a, Vector b, Vector c) {
        return hn::NegMulAdd(a.v, b.v, c.v);
    }

    friend LAMINA_INLINE Vector select(Mask mask, Vector yes, Vector no) {
        return hn::IfThenElse(own(mask), yes.v, no.v);
    }
    friend LAMINA_INLINE Vector zero_unless(Mask mask, Vector a) {
        return hn::IfThenElseZero(own(mask), a.v);
    }
    friend LAMINA_INLINE Vector zero_if(Mask mask, Vector a) {
        return hn::IfThenZeroElse(own(mask), a.v);
    }

    // Stores a whole vector. store() and load() need memory that is aligned to vectors.
    friend LAMINA_INLINE void store(Vector a, Scalar* to) { hn::Store(a.v, D(), to); }
    friend LAMINA_INLINE void store_unaligned(Vector a, Scalar* to) { hn::StoreU(a.v, D(), to); }

  private:
    template <class Any>
    static LAMINA_INLINE Mask mask(Any lanes) {
        return hn::RebindMask(MaskTag(), lanes);
    }
    static LAMINA_INLINE hn::Mask<D> own(Mask lanes) { return hn::RebindMask(D(), lanes.m); }
};

template <class V>
LAMINA_INLINE V load(const typename V::Scalar* from) {
    return hn::Load(typename V::Tag(), from);
}
template <class V>
LAMINA_INLINE V load_unaligned(const typename V::Scalar* from) {
    return hn::LoadU(typename V::Tag(), from);
}
// Loads the lanes of `mask`. The others become 0, and their memory is not read.
template <class V>
LAMINA_INLINE V load_masked(typename V::Mask mask, const typename V::Scalar* from) {
    return hn::MaskedLoad(mask.m, typename V::Tag(), from);
}
// Loads vectors that are interleaved in memory: a, b, c, d of lane 0, then of lane 1, and so on.
template <class V>
LAMINA_INLINE void load_interleaved(const typename V::Scalar* from, V& a, V& b, V& c, V& d) {
    hn::LoadInterleaved4(typename V::Tag(), from, a.v, b.v, c.v, d.v);
}
template <class V>
LAMINA_INLINE void load_interleaved(const typename V::Scalar* from, V& a, V& b) {
    hn::LoadInterleaved2(typename V::Tag(), from, a.v, b.v);
}
template <class V>
LAMINA_INLINE V iota(typename V::Scalar first) {
    return hn::Iota(typename V::Tag(), first);
}

template <class V, std::size_t count>
LAMINA_INLINE V polynomial(V x, const typename V::Scalar (&c)[count]) {
    V sum = c[count - 1];
    for (std::size_t i = count - 1; i-- > 0;) sum = sum * x + c[i];
    return sum;
}
template <class V>
LAMINA_INLINE V mix(V a, V b, V share) {
    return a + share * (b - a);
}
template <class V>
LAMINA_INLINE V clamp01(V a) {
    return clamp(a, 0, 1);
}

template <int bits, class V>
LAMINA_INLINE V shift_left(V a) {
    return hn::ShiftLeft<bits>(a.v);
}
template <int bits, class V>
LAMINA_INLINE V shift_right(V a) {
    return hn::ShiftRight<bits>(a.v);
}
// Shifts each lane of `a` by the number in the same lane of `bits`.
template <class V>
LAMINA_INLINE V shift_right(V a, V bits) {
    return hn::Shr(a.v, bits.v);
}

template <class V>
LAMINA_INLINE typename V::Scalar first_of(V a) {
    return hn::GetLane(a.v);
}
template <class V>
LAMINA_INLINE typename V::Scalar least_of(V a) {
    return hn::GetLane(hn::MinOfLanes(typename V::Tag(), a.v));
}
template <class V>
LAMINA_INLINE typename V::Scalar largest_of(V a) {
    return hn::GetLane(hn::MaxOfLanes(typename V::Tag(), a.v));
}

using Float = Vector<hn::CappedTag<float, most_lanes>>;
using Int = Vector<hn::RebindToSigned<Float::Tag>>;
using Word = Vector<hn::RebindToUnsigned<Float::Tag>>;
using FloatMask = Float::Mask;

using Double = Vector<hn::Repartition<double, Float::Tag>>;
using Long = Vector<hn::RebindToSigned<Double::Tag>>;
using Word64 = Vector<hn::RebindToUnsigned<Double::Tag>>;
using DoubleMask = Double::Mask;

// Vectors of fixed length: four floats; and eight, if the instruction set has vectors that long.
using Float4 = Vector<hn::FixedTag<float, 4>>;
using Int4 = Vector<hn::RebindToSigned<Float4::Tag>>;
using Float8 = Vector<hn::CappedTag<float, 8>>;
using Word8 = Vector<hn::RebindToUnsigned<Float8::Tag>>;

// Return the halves of a Float8 that has eight lanes.
template <class V>
LAMINA_INLINE Float4 lower_half(V a) {
    return hn::LowerHalf(Float4::Tag(), a.v);
}
template <class V>
LAMINA_INLINE Float4 upper_half(V a) {
    return hn::UpperHalf(Float4::Tag(), a.v);
}

// Convert lane by lane; to_int() and to_long() round towards zero.
LAMINA_INLINE Float to_float(Int a) {
    return hn::ConvertTo(Float::Tag(), a.v);
}
LAMINA_INLINE Int to_int(Float a) {
    return hn::ConvertTo(Int::Tag(), a.v);
}
// Returns the nearest whole number; of two, the even one.
LAMINA_INLINE Int nearest_int(Float a) {
    return hn::NearestInt(a.v);
}
LAMINA_INLINE Double to_double(Long a) {
    return hn::ConvertTo(Double::Tag(), a.v);
}
LAMINA_INLINE Long to_long(Double a) {
    return hn::ConvertTo(Long::Tag(), a.v);
}
LAMINA_INLINE Double rounded_to_float(Double a) {
    return hn::PromoteTo(Double::Tag(), hn::DemoteTo(hn::Rebind<float, Double::Tag>(), a.v));
}
LAMINA_INLINE void store_as_floats(Double a, float* to) {
    const hn::Rebind<float, Double::Tag> floats;
    hn::Store(hn::DemoteTo(floats, a.v), floats, to);
}
// Stores whole numbers as the bits of 32-bit integers.
LAMINA_INLINE void store_as_int_bits(Double whole, float* to) {
    const hn::Rebind<float, Double::Tag> floats;
    const hn::Rebind<std::int32_t, Double::Tag> ints;
    hn::Store(hn::BitCast(floats, hn::DemoteTo(ints, whole.v)), floats, to);
}
// Load whole numbers that have one byte, or two, in memory.
LAMINA_INLINE Int load_bytes(const std::uint8_t* from) {
    return hn::PromoteTo(Int::Tag(), hn::LoadU(hn::Rebind<std::uint8_t, Int::Tag>(), from));
}
LAMINA_INLINE Word load_halves(const std::uint16_t* from) {
    return hn::PromoteTo(Word::Tag(), hn::LoadU(hn::Rebind<std::uint16_t, Word::Tag>(), from));
}

LAMINA_INLINE void store_low_bytes(Word8 a, std::uint8_t* to) {
    const hn::Rebind<std::uint8_t, Word8::Tag> bytes;
    hn::StoreU(hn::TruncateTo(bytes, a.v), bytes, to);
}

template <class To, class D>
LAMINA_INLINE To bits_as(Vector<D> a) {
    return hn::BitCast(typename To::Tag(), a.v);
}

template <class T, class D>
LAMINA_INLINE auto gather(const T* from, Vector<D> place) {
    using Tag = hn::Rebind<T, D>;
    return Vector<Tag>(hn::GatherIndex(Tag(), from, place.v));
}
// Returns the numbers at `place` and those behind them. One instruction gathers both.
struct FloatPairs {
    Float first, second;
};
LAMINA_INLINE FloatPairs gather_pairs(const float* from, Int place) {
#if HWY_TARGET <= HWY_AVX2
    const hn::Half<Int::Tag> half;
    const auto pairs = [&](auto places) LAMINA_LAMBDA {
        const auto bytes = hn::ShiftLeft<2>(hn::PromoteTo(Long::Tag(), places));
        return hn::BitCast(
            Float::Tag(),
            hn::GatherOffset(Long::Tag(), reinterpret_cast<const std::int64_t*>(from), bytes));
    };
    const auto low = pairs(hn::LowerHalf(half, place.v)),
               high = pairs(hn::UpperHalf(half, place.v));
    return {hn::ConcatEven(Float::Tag(), high, low), hn::ConcatOdd(Float::Tag(), high, low)};
#else
    return {gather(from, place), gather(from + 1, place)};
#endif
}
// Returns the word that begins `bytes` behind `from`.
LAMINA_INLINE Word gather_at_bytes(const std::uint32_t* from, Int bytes) {
    return hn::GatherOffset(Word::Tag(), from, bytes.v);
}
LAMINA_INLINE Int gather_at_bytes(const std::int32_t* from, Int bytes) {
    return hn::GatherOffset(Int::Tag(), from, bytes.v);
}

LAMINA_INLINE Long minus_one_in(DoubleMask mask) {
    return hn::VecFromMask(Long::Tag(), hn::RebindMask(Long::Tag(), mask.m));
}

// Returns in each lane the lane of `a` whose number is in that lane of `place`.
template <class D, class I>
LAMINA_INLINE Vector<D> permute(Vector<D> a, Vector<I> place) {
    return hn::TableLookupLanes(a.v, hn::IndicesFromVec(D(), place.v));
}

// Transposes 4 x 4 numbers: lane i of row j becomes lane j of row i.
LAMINA_INLINE void transpose(Float4 (&rows)[4]) {
    const Float4::Tag d;
    const auto low02 = hn::InterleaveLower(d, rows[0].v, rows[2].v);
    const auto low13 = hn::InterleaveLower(d, rows[1].v, rows[3].v);
    const auto high02 = hn::InterleaveUpper(d, rows[0].v, rows[2].v);
    const auto high13 = hn::InterleaveUpper(d, rows[1].v, rows[3].v);
    rows[0] = hn::InterleaveLower(d, low02, low13);
    rows[1] = hn::InterleaveUpper(d, low02, low13);
    rows[2] = hn::InterleaveLower(d, high02, high13);
    rows[3] = hn::InterleaveUpper(d, high02, high13);
}

struct Float64Mask {
    DoubleMask low, high;

    friend LAMINA_INLINE Float64Mask operator&(Float64Mask a, Float64Mask b) {
        return {a.low & b.low, a.high & b.high};
    }
    friend LAMINA_INLINE Float64Mask operator|(Float64Mask a, Float64Mask b) {
        return {a.low | b.low, a.high | b.high};
    }
    friend LAMINA_INLINE bool any_of(Float64Mask a) { return any_of(a.low) || any_of(a.high); }
    friend LAMINA_INLINE bool none_of(Float64Mask a) { return none_of(a.low) && none_of(a.high); }
    friend LAMINA_INLINE bool all_of(Float64Mask a) { return all_of(a.low) && all_of(a.high); }
};

// The lanes of a Float in double precision; `low` holds the first half of them.
struct Float64 {
    using Scalar = double;
    using Mask = Float64Mask;

    Double low, high;

    Float64() = default;
    LAMINA_INLINE Float64(Double first, Double last) : low(first), high(last) {}
    LAMINA_INLINE Float64(double all) : low(all), high(all) {}
    LAMINA_INLINE explicit Float64(Float a)
        : low(hn::PromoteTo(Double::Tag(), hn::LowerHalf(hn::Half<Float::Tag>(), a.v))),
          high(hn::PromoteTo(Double::Tag(), hn::UpperHalf(hn::Half<Float::Tag>(), a.v))) {}
    LAMINA_INLINE explicit Float64(Int a)
        : low(hn::PromoteTo(Double::Tag(), hn::LowerHalf(hn::Half<Int::Tag>(), a.v))),
          high(hn::PromoteTo(Double::Tag(), hn::UpperHalf(hn::Half<Int::Tag>(), a.v))) {}
    // Converts exactly by way of signed numbers, because only these have an instruction.
    LAMINA_INLINE explicit Float64(Word a)
        : Float64(Float64(bits_as<Int>(a ^ Word(0x80000000u))) + Float64(0x1p31)) {}

    friend LAMINA_INLINE Float64 operator-(Float64 a) { return {-a.low, -a.high}; }
    friend LAMINA_INLINE Float64& operator+=(Float64& a, Float64 b) { return a = a + b; }
    friend LAMINA_INLINE Float64& operator*=(Float64& a, Float64 b) { return a = a * b; }

    friend LAMINA_INLINE Float64 min(Float64 a, Float64 b) {
        return {min(a.low, b.low), min(a.high, b.high)};
    }
    friend LAMINA_INLINE Float64 max(Float64 a, Float64 b) {
        return {max(a.low, b.low), max(a.high, b.high)};
    }
    friend LAMINA_INLINE Float64 clamp(Float64 a, Float64 least, Float64 most) {
        return min(max(a, least), most);
    }
    friend LAMINA_INLINE Float64 abs(Float64 a) { return {abs(a.low), abs(a.high)}; }
    friend LAMINA_INLINE Float64 sqrt(Float64 a) { return {sqrt(a.low), sqrt(a.high)}; }
    friend LAMINA_INLINE Float64 floor(Float64 a) { return {floor(a.low), floor(a.high)}; }
    friend LAMINA_INLINE Float64 ceil(Float64 a) { return {ceil(a.low), ceil(a.high)}; }

    friend LAMINA_INLINE Float64 select(Float64Mask mask, Float64 yes, Float64 no) {
        return {select(mask.low, yes.low, no.low), select(mask.high, yes.high, no.high)};
    }
    friend LAMINA_INLINE Float64 zero_unless(Float64Mask mask, Float64 a) {
        return {zero_unless(mask.low, a.low), zero_unless(mask.high, a.high)};
    }

    friend LAMINA_INLINE void store(Float64 a, double* to) {
        store(a.low, to);
        store(a.high, to + Double::lanes);
    }
    friend LAMINA_INLINE double least_of(Float64 a) { return least_of(min(a.low, a.high)); }
    friend LAMINA_INLINE double largest_of(Float64 a) { return largest_of(max(a.low, a.high)); }

#define LAMINA_FLOAT64_OPERATOR(Result, op)                         \
    friend LAMINA_INLINE Result operator op(Float64 a, Float64 b) { \
        return {a.low op b.low, a.high op b.high};                  \
    }
    LAMINA_FLOAT64_OPERATOR(Float64, +)
    LAMINA_FLOAT64_OPERATOR(Float64, -)
    LAMINA_FLOAT64_OPERATOR(Float64, *)
    LAMINA_FLOAT64_OPERATOR(Float64, /)
    LAMINA_FLOAT64_OPERATOR(Float64Mask, <)
    LAMINA_FLOAT64_OPERATOR(Float64Mask, >)
    LAMINA_FLOAT64_OPERATOR(Float64Mask, <=)
    LAMINA_FLOAT64_OPERATOR(Float64Mask, >=)
    LAMINA_FLOAT64_OPERATOR(Float64Mask, ==)
#undef LAMINA_FLOAT64_OPERATOR
};

LAMINA_INLINE Float to_float(const Float64& a) {
    const hn::Half<Float::Tag> half;
    return hn::Combine(Float::Tag(), hn::DemoteTo(half, a.high.v), hn::DemoteTo(half, a.low.v));
}
// Converts whole numbers within the range of int.
LAMINA_INLINE Int to_int(const Float64& whole) {
    const hn::Half<Int::Tag> half;
    return hn::Combine(Int::Tag(), hn::DemoteTo(half, whole.high.v),
                       hn::DemoteTo(half, whole.low.v));
}
LAMINA_INLINE Float64 load_float64(const double* from) {
    return {load<Double>(from), load<Double>(from + Double::lanes)};
}
LAMINA_INLINE FloatMask to_float_mask(const Float64Mask& a) {
    return to_float(zero_unless(a, Float64(1.0))) > Float(0);
}
LAMINA_INLINE FloatMask to_float_mask(FloatMask a) {
    return a;
}

// Overloads of the vector functions for one double, for templates over the number type.
LAMINA_INLINE double min(double a, double b) {
    return std::min(a, b);
}
LAMINA_INLINE double max(double a, double b) {
    return std::max(a, b);
}
LAMINA_INLINE double clamp(double a, double least, double most) {
    return std::min(std::max(a, least), most);
}
LAMINA_INLINE double abs(double a) {
    return std::abs(a);
}
LAMINA_INLINE double sqrt(double a) {
    return std::sqrt(a);
}
LAMINA_INLINE double floor(double a) {
    return std::floor(a);
}
LAMINA_INLINE double select(bool mask, double yes, double no) {
    return mask ? yes : no;
}
LAMINA_INLINE double rounded_to_float(double a) {
    return static_cast<double>(static_cast<float>(a));
}

LAMINA_SIMD_END

#endif
