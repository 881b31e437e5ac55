// SPDX-License-Identifier: Apache-2.0
// Vectors of segments that are cut in rounds: each round has one piece of each segment.
#if defined(LAMINA_REFERENCE_ROUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_REFERENCE_ROUNDS_INL_H_
#undef LAMINA_REFERENCE_ROUNDS_INL_H_
#else
#define LAMINA_REFERENCE_ROUNDS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Takes a vector of segments to their ends. Returns the number of rounds.
template <typename Segments, typename Rounds>
LAMINA_INLINE std::size_t take_rounds(Segments& segments, Rounds& rounds) {
    std::size_t count = 0;
    while (segments.active()) {
        if (count == rounds.size()) rounds.resize(2 * count + 8);
        segments.advance(rounds[count++]);
    }
    return count;
}

// Appends the pieces of some rounds, one segment after the other. store(i, round, lane) stores a
// piece at place i.
template <typename Pieces, typename Store>
LAMINA_INLINE void append_rounds(std::size_t count, std::size_t first_segment, Pieces& pieces,
                                 const Store& store) {
    auto& rounds = pieces.rounds;
    const std::size_t lanes = Double::lanes;
    pieces.make_room(pieces.count + lanes * count);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        for (std::size_t number = 0; number < count; ++number) {
            // Written over by the next where it is not kept: a branch would often be mispredicted.
            const auto& round = rounds[number];
            pieces.segment[pieces.count] = static_cast<std::int64_t>(first_segment + lane);
            store(pieces.count, round, lane);
            pieces.count += round.kept >> lane & 1;
        }
    }
}

}  // namespace reference
LAMINA_SIMD_END

#endif
