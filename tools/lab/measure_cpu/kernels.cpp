// SPDX-License-Identifier: Apache-2.0
#include "measure_cpu/kernels.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "measure_cpu/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<float> df;
constexpr hn::ScalableTag<std::int32_t> di;
constexpr hn::ScalableTag<std::uint32_t> du;
using Floats = hn::Vec<hn::ScalableTag<float>>;
using Bits = hn::Vec<hn::ScalableTag<std::uint32_t>>;

int lane_count() {
    return static_cast<int>(hn::Lanes(df));
}

// Computes x = step(x) in all chains, in registers. The chains begin with different numbers, so
// that the compiler cannot merge them.
template <class F>
HWY_INLINE float run_chains(std::int64_t rounds, F step) {
    const auto start = [](float number) HWY_ATTR { return hn::Set(df, number); };
    Floats a = start(1.01f), b = start(1.02f), c = start(1.03f), d = start(1.04f);
    Floats e = start(1.05f), f = start(1.06f), g = start(1.07f), h = start(1.08f);
    Floats i = start(1.09f), j = start(1.10f), k = start(1.11f), l = start(1.12f);
    for (std::int64_t round = 0; round < rounds; ++round) {
        a = step(a), b = step(b), c = step(c), d = step(d), e = step(e), f = step(f);
        g = step(g), h = step(h), i = step(i), j = step(j), k = step(k), l = step(l);
    }
    const auto first = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, d)), hn::Add(e, f));
    const auto second = hn::Add(hn::Add(hn::Add(g, h), hn::Add(i, j)), hn::Add(k, l));
    return hn::GetLane(hn::SumOfLanes(df, hn::Add(first, second)));
}

// The factor and the summand are known only at run time. x stays near 2 b / 3.
float run_multiply_and_add(std::int64_t rounds, float factor, float summand) {
    const auto a = hn::Set(df, factor), b = hn::Set(df, summand);
    return run_chains(rounds, [=](Floats x) HWY_ATTR { return hn::Add(hn::Mul(x, a), b); });
}

float run_divide(std::int64_t rounds, float dividend) {
    const auto a = hn::Set(df, dividend);
    return run_chains(rounds, [=](Floats x) HWY_ATTR { return hn::Div(a, x); });
}

HWY_INLINE Floats gather(Bits index, const float* table) {
    return hn::GatherIndex(df, table, hn::BitCast(di, index));
}

// The addresses come from four linear congruential generators (Knuth's multiplier), of which the
// upper bits are used.
float run_gather_anywhere(std::span<const float> table, std::int64_t rounds) {
    const int shift = 33 - static_cast<int>(std::bit_width(table.size()));
    const auto factor = hn::Set(du, 1664525u), step = hn::Set(du, 1013904223u);
    Bits states[gathers];
    Floats sums[gathers];
    for (int i = 0; i < gathers; ++i) {
        const auto number = hn::Iota(du, static_cast<std::uint32_t>(64 * i));
        states[i] = hn::Mul(number, hn::Set(du, 0x9e3779b9u));
        sums[i] = hn::Zero(df);
    }
    for (std::int64_t round = 0; round < rounds; ++round) {
        for (int i = 0; i < gathers; ++i) {
            states[i] = hn::Add(hn::Mul(states[i], factor), step);
            const auto index = hn::ShiftRightSame(states[i], shift);
            sums[i] = hn::Add(sums[i], gather(index, table.data()));
        }
    }
    const auto sum = hn::Add(hn::Add(sums[0], sums[1]), hn::Add(sums[2], sums[3]));
    return hn::GetLane(hn::SumOfLanes(df, sum));
}

float run_gather_blocks(std::span<const float> table, std::int64_t rounds) {
    constexpr std::uint32_t row = 256;
    const auto mask = hn::Set(du, static_cast<std::uint32_t>(table.size() - 1));
    const auto lane = hn::Iota(du, 0u);
    const auto place =
        hn::Add(hn::And(lane, hn::Set(du, 3u)), hn::Mul(hn::ShiftRight<2>(lane), hn::Set(du, row)));
    Floats sums[gathers];
    for (Floats& sum : sums) sum = hn::Zero(df);
    // A round has four blocks, each 4 numbers further. After a row of blocks it goes on 4 rows
    // below.
    std::uint32_t first = 0;
    for (std::int64_t round = 0; round < rounds; ++round) {
        for (std::uint32_t i = 0; i < gathers; ++i) {
            const auto index = hn::And(hn::Add(place, hn::Set(du, first + 4 * i)), mask);
            sums[i] = hn::Add(sums[i], gather(index, table.data()));
        }
        first += 4 * gathers;
        if (first % row == 0) first += 3 * row;
    }
    const auto sum = hn::Add(hn::Add(sums[0], sums[1]), hn::Add(sums[2], sums[3]));
    return hn::GetLane(hn::SumOfLanes(df, sum));
}

float run_read(std::span<const float> numbers) {
    const std::size_t lanes = hn::Lanes(df);
    auto a = hn::Zero(df), b = a, c = a, d = a;
    for (std::size_t i = 0; i + 4 * lanes <= numbers.size(); i += 4 * lanes) {
        a = hn::Add(a, hn::LoadU(df, numbers.data() + i));
        b = hn::Add(b, hn::LoadU(df, numbers.data() + i + lanes));
        c = hn::Add(c, hn::LoadU(df, numbers.data() + i + 2 * lanes));
        d = hn::Add(d, hn::LoadU(df, numbers.data() + i + 3 * lanes));
    }
    return hn::GetLane(hn::SumOfLanes(df, hn::Add(hn::Add(a, b), hn::Add(c, d))));
}

void run_triad(std::span<float> a, std::span<const float> b, std::span<const float> c) {
    const auto half = hn::Set(df, 0.5f);
    for (std::size_t i = 0; i + hn::Lanes(df) <= a.size(); i += hn::Lanes(df)) {
        const auto product = hn::Mul(half, hn::LoadU(df, c.data() + i));
        hn::StoreU(hn::Add(hn::LoadU(df, b.data() + i), product), df, a.data() + i);
    }
}

}  // namespace
}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(lane_count);
HWY_EXPORT(run_multiply_and_add);
HWY_EXPORT(run_divide);
HWY_EXPORT(run_gather_anywhere);
HWY_EXPORT(run_gather_blocks);
HWY_EXPORT(run_read);
HWY_EXPORT(run_triad);

int float_lanes() {
    return HWY_DYNAMIC_DISPATCH(lane_count)();
}
float multiply_and_add(std::int64_t rounds, float factor, float summand) {
    return HWY_DYNAMIC_DISPATCH(run_multiply_and_add)(rounds, factor, summand);
}
float divide(std::int64_t rounds, float dividend) {
    return HWY_DYNAMIC_DISPATCH(run_divide)(rounds, dividend);
}
float gather_anywhere(std::span<const float> table, std::int64_t rounds) {
    return HWY_DYNAMIC_DISPATCH(run_gather_anywhere)(table, rounds);
}
float gather_blocks(std::span<const float> table, std::int64_t rounds) {
    return HWY_DYNAMIC_DISPATCH(run_gather_blocks)(table, rounds);
}
float read_all(std::span<const float> numbers) {
    return HWY_DYNAMIC_DISPATCH(run_read)(numbers);
}
void triad(std::span<float> a, std::span<const float> b, std::span<const float> c) {
    HWY_DYNAMIC_DISPATCH(run_triad)(a, b, c);
}

}  // namespace lamina
#endif
