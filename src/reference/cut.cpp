// SPDX-License-Identifier: Apache-2.0
#include "reference/cut.h"

#include <cmath>

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/cut.cpp"
#include "simd/foreach_target.h"

#include "reference/cut-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

// Cuts a vector of segments, step by step. Returns the number of steps.
template <typename Segments, typename Steps>
LAMINA_INLINE std::size_t take_steps(Segments& segments, Steps& steps) {
    std::size_t count = 0;
    while (segments.active()) {
        if (count == steps.size()) steps.resize(2 * count + 8);
        segments.advance(steps[count++]);
    }
    return count;
}

// Appends the kept pieces, lane by lane; store(i, step, lane) stores what PieceColumns lacks.
template <typename Pieces, typename Store>
LAMINA_INLINE void append_steps(std::size_t count, std::size_t first_segment, Pieces& pieces,
                                const Store& store) {
    auto& steps = pieces.steps;
    const std::size_t lanes = Double::lanes;
    pieces.make_room(pieces.count + lanes * count);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        for (std::size_t number = 0; number < count; ++number) {
            // A piece that is not kept is overwritten: branches would be mispredicted.
            const auto& step = steps[number];
            const std::size_t i = pieces.count;
            pieces.segment[i] = static_cast<std::int64_t>(first_segment + lane);
            pieces.interval[i] = step.interval[lane];
            pieces.start[i] = step.start[lane];
            pieces.end[i] = step.end[lane];
            store(i, step, lane);
            pieces.count += step.kept >> lane & 1;
        }
    }
}

// Cuts a vector of cubic segments; advance() takes one step of the loop in cut.h.
class SegmentLanes {
  public:
    LAMINA_INLINE SegmentLanes(const SegmentBatch& segments, std::size_t first,
                               const IntervalColumns& columns)
        : search_(columns),
          active_(first_lanes<DoubleMask>(segments.count - first)),
          lo_(given(segments.lo + first)),
          hi_(given(segments.hi + first)),
          at_(0) {
        for (std::size_t power = 0; power < 4; ++power)
            scalar_.c[power] = given(segments.scalar[power] + first);
        // A constant scalar may equal the interval's upper knot: aim() decides the side of a step.
        lowest_ = search_.above(lo_);
        const DoubleMask whole = (hi_ <= search_.upper(lowest_)) & !scalar_.constant();
        const Turns turns = turns_of(scalar_);
        turn_ = select(whole, 1, turns.first);
        next_turn_ = turns.second;
        value_ = value_at(at_);
        aim();
        interval_ = select(whole, lowest_, interval_);
    }

    LAMINA_INLINE bool active() const { return any_of(active_); }

    LAMINA_INLINE void advance(CubicStep& step) {
        const Double knot = search_.knot_ahead(interval_, rises_);
        const DoubleMask before_turn =
            (rises_ & (knot < turn_value_)) | without(knot > turn_value_, rises_);
        const DoubleMask crosses = active_ & before_turn;
        const Double end = select(crosses, knot, turn_value_);
        Double to = turn_;
        if (any_of(crosses)) {
            const DoubleMask away = crosses & (knot != value_);
            const Double root = solve_monotone(scalar_, knot, at_, turn_, away);
            to = select(crosses, select(away, root, at_), to);
        }
        fill(step, to, end);
        at_ = to;
        value_ = end;
        interval_ = select(crosses, search_.beyond(interval_, rises_), interval_);
        const DoubleMask turned = without(active_, crosses);
        active_ = active_ & (crosses | (at_ < 1));
        if (any_of(turned & active_)) pass_turn(turned);
    }

  private:
    // Loads numbers of the segments. Lanes behind the last segment are 0.
    LAMINA_INLINE Double given(const double* from) const {
        return load_masked<Double>(active_, from);
    }

    LAMINA_INLINE Double value_at(Double t) const { return clamp(scalar_.at(t), lo_, hi_); }

    LAMINA_INLINE void aim() {
        turn_value_ = value_at(turn_);
        rises_ = value_ <= turn_value_;
        interval_ = search_.onwards(lowest_, value_, rises_);
    }

    // Aims at the next turn in lanes that have turned; in others direction and interval remain.
    LAMINA_INLINE void pass_turn(DoubleMask turned) {
        turn_ = select(turned, next_turn_, turn_);
        next_turn_ = select(turned, 1, next_turn_);
        aim();
    }

    LAMINA_INLINE void fill(CubicStep& step, Double to, Double end) const {
        const DoubleMask kept = active_ & search_.shows(interval_) & (at_ < to);
        step.kept = static_cast<std::uint8_t>(bits_of(kept));
        store(interval_, step.interval);
        store(at_, step.from);
        store(to, step.to);
        store(value_, step.start);
        store(end, step.end);
    }

    IntervalSearch search_;
    DoubleMask active_;
    Double lo_, hi_;
    Cubics scalar_;
    Double at_, value_;                     // current t, and the scalar there
    Double turn_, next_turn_, turn_value_;  // the next two turns, or 1, and the scalar at the first
    DoubleMask rises_;                      // lanes in which the scalar rises towards the turn
    Long lowest_, interval_;                // intervals: of lo_, and of the next piece
};

// Sets position, extinction, depth and allowed errors of a vector of pieces. Extinction is computed
// from the nearer knot, so that few digits are lost where it is steep.
LAMINA_INLINE void set_optics(const SegmentBatch& segments, const IntervalColumns& columns,
                              double error_per_length, std::size_t i, PieceBatch& pieces) {
    const IntervalSearch search(columns);
    const Long segment = load_unaligned<Long>(pieces.segment.data() + i);
    const Long interval = load_unaligned<Long>(pieces.interval.data() + i);
    const Double from = load_unaligned<Double>(pieces.from.data() + i);
    const Double to = load_unaligned<Double>(pieces.to.data() + i);
    Cubics whole;
    for (std::size_t power = 0; power < 4; ++power)
        whole.c[power] = gather(segments.scalar[power], segment);
    const Cubics scalar =
        restricted(whole, from, to, load_unaligned<Double>(pieces.start.data() + i),
                   load_unaligned<Double>(pieces.end.data() + i));
    const Double length = gather(segments.length, segment) * (to - from);
    const Double inverse = search.of(columns.inverse_width, interval);
    const Double at_lo = search.of(columns.extinction, interval);
    const Double change = search.of(columns.extinction_change, interval);
    const Double from_lo = (scalar.c[0] - search.of(columns.lo, interval)) * inverse;
    const Double from_hi = (search.of(columns.hi, interval) - scalar.c[0]) * inverse;
    const Double first = select(from_lo < from_hi, fma(change, from_lo, at_lo),
                                fnma(change, from_hi, at_lo + change));
    Cubics position, extinction;
    position.c[0] = from_lo;
    extinction.c[0] = max(first, 0) * length;
    for (std::size_t power = 1; power < 4; ++power) {
        position.c[power] = scalar.c[power] * inverse;
        extinction.c[power] = change * position.c[power] * length;
    }
    Double depth = Double(0);
    for (std::size_t power = 4; power-- > 0;) {
        store_unaligned(position.c[power], pieces.position[power].data() + i);
        store_unaligned(extinction.c[power], pieces.extinction[power].data() + i);
        depth += extinction.c[power] * (1 / static_cast<double>(power + 1));
    }
    store_unaligned(max(depth, 0), pieces.depth.data() + i);
    store_unaligned(error_per_length * length, pieces.error_of_length.data() + i);
    store_unaligned(search.of(columns.color_span, interval), pieces.color_span.data() + i);
}

// Limits the optical depths of pieces, so that sums of them stay finite.
constexpr double largest_depth = 1e300;
// Limits scalars: differences of larger ones might overflow.
constexpr double largest_scalar = std::numeric_limits<double>::max() / 4;

// Cuts a vector of linear segments, as SegmentLanes does cubic ones.
class LinearLanes {
  public:
    LAMINA_INLINE LinearLanes(const LinearSegments& segments, std::size_t first,
                              const IntervalColumns& columns)
        : search_(columns),
          active_(first_lanes<DoubleMask>(segments.count - first)),
          front_(finite(segments.front + first)),
          back_(finite(segments.back + first)),
          value_(front_),
          rises_(front_ <= back_),
          constant_(front_ == back_),
          interval_(search_.ahead(front_, rises_)) {}

    LAMINA_INLINE bool active() const { return any_of(active_); }

    LAMINA_INLINE void advance(LinearStep& step) {
        const Double knot = search_.knot_ahead(interval_, rises_);
        const Double end = select(rises_, min(knot, back_), max(knot, back_));
        // Both differences are of doubles that are given exactly, so the share is accurate.
        const Double share = (end - value_) / (back_ - front_);
        const DoubleMask has_length = constant_ | (end != value_);
        const DoubleMask kept = active_ & search_.shows(interval_) & has_length;
        step.kept = static_cast<std::uint8_t>(bits_of(kept));
        store(interval_, step.interval);
        store(value_, step.start);
        store(select(constant_, back_, end), step.end);
        store(select(constant_, 1, share), step.share);
        value_ = end;
        active_ = without(active_, constant_ | (value_ == back_));
        interval_ = select(active_, search_.beyond(interval_, rises_), interval_);
    }

  private:
    LAMINA_INLINE Double finite(const double* from) const {
        return clamp(load_masked<Double>(active_, from), -largest_scalar, largest_scalar);
    }

    IntervalSearch search_;
    DoubleMask active_;
    Double front_, back_, value_;  // scalars at the ends, and at the current place
    DoubleMask rises_, constant_;
    Long interval_;
};

// Appends the pieces of a single step: most vectors of segments have no more.
LAMINA_INLINE void append_step(const LinearStep& step, std::size_t first_segment,
                               LinearPieces& pieces) {
    const KeptLanes kept(mask_of_bits<DoubleMask>(step.kept));
    const std::size_t end = pieces.count;
    pieces.make_room(end + Double::lanes);
    kept.store(iota<Long>(static_cast<std::int64_t>(first_segment)), pieces.segment.data() + end);
    kept.store(load<Long>(step.interval), pieces.interval.data() + end);
    kept.store(load<Double>(step.start), pieces.start.data() + end);
    kept.store(load<Double>(step.end), pieces.end.data() + end);
    kept.store(load<Double>(step.share), pieces.share.data() + end);
    pieces.count += kept.count();
}

// Positions in an interval: 0..1 from its lower knot, and from its upper one.
struct PlaceLanes {
    Double from_lo, from_hi;

    LAMINA_INLINE PlaceLanes(Double value, Double lo, Double hi) {
        const auto share = [&](Double way) LAMINA_LAMBDA { return clamp(way / (hi - lo), 0, 1); };
        from_lo = share(value - lo);
        from_hi = share(hi - value);
    }
};

// Sets places, p, q and depth of a vector of pieces, from their scalars and shares.
LAMINA_INLINE void set_depths(const LinearSegments& segments, const IntervalColumns& columns,
                              std::size_t i, LinearPieces& pieces) {
    const IntervalSearch search(columns);
    const Long interval = load_unaligned<Long>(pieces.interval.data() + i);
    const Double length = gather(segments.length, load_unaligned<Long>(pieces.segment.data() + i)) *
                          load_unaligned<Double>(pieces.share.data() + i);
    const Double lo = search.of(columns.lo, interval), hi = search.of(columns.hi, interval);
    const Double at_lo = search.of(columns.extinction, interval);
    const Double at_hi = search.of(columns.extinction_end, interval);
    // No term is negative, so nothing cancels.
    const auto depth = [&](const PlaceLanes& place) LAMINA_LAMBDA {
        const Double mixed = fma(at_lo, place.from_hi, at_hi * place.from_lo);
        const Double extinction = select(at_lo == at_hi, at_lo, mixed);
        return min(extinction * length, largest_depth);
    };
    const PlaceLanes from(load_unaligned<Double>(pieces.start.data() + i), lo, hi);
    const PlaceLanes to(load_unaligned<Double>(pieces.end.data() + i), lo, hi);
    const Double p = depth(from), q = depth(to);
    store_unaligned(from.from_lo, pieces.start_place.data() + i);
    store_unaligned(to.from_lo, pieces.end_place.data() + i);
    store_unaligned(p, pieces.p.data() + i);
    store_unaligned(q, pieces.q.data() + i);
    store_unaligned(fma(0.5, p, 0.5 * q), pieces.depth.data() + i);
}

}  // namespace reference

inline void append_pieces_of(const SegmentBatch& segments, const IntervalColumns& columns,
                             double error_per_length, PieceBatch& pieces) {
    using namespace reference;
    const std::size_t lanes = Double::lanes, first = pieces.count;
    const auto put = [&](std::size_t i, const CubicStep& step, std::size_t lane) {
        pieces.from[i] = step.from[lane];
        pieces.to[i] = step.to[lane];
    };
    for (std::size_t i = 0; i < segments.count; i += lanes) {
        SegmentLanes on_their_way(segments, i, columns);
        append_steps(take_steps(on_their_way, pieces.steps), i, pieces, put);
    }
    for (std::size_t i = first; i < pieces.count; i += lanes)
        set_optics(segments, columns, error_per_length, i, pieces);
}

inline void append_linear_pieces_of(const LinearSegments& segments, const IntervalColumns& columns,
                                    LinearPieces& pieces) {
    using namespace reference;
    const std::size_t lanes = Double::lanes, first = pieces.count;
    const auto put = [&](std::size_t i, const LinearStep& step, std::size_t lane) {
        pieces.share[i] = step.share[lane];
    };
    for (std::size_t i = 0; i < segments.count; i += lanes) {
        LinearLanes on_their_way(segments, i, columns);
        const std::size_t steps = take_steps(on_their_way, pieces.steps);
        if (steps == 1) {
            append_step(pieces.steps[0], i, pieces);
        } else {
            append_steps(steps, i, pieces, put);
        }
    }
    for (std::size_t i = first; i < pieces.count; i += lanes)
        set_depths(segments, columns, i, pieces);
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

CubicTurns turns_of(const Cubic& cubic) {
    // Derivative a t^2 + 2 b t + c, scaled so that no square of a coefficient underflows; the
    // quotient form has no cancellation (Press et al., Numerical Recipes, 5.6).
    double a = 3 * cubic.c[3], b = cubic.c[2], c = cubic.c[1];
    const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
    a /= largest;
    b /= largest;
    c /= largest;
    const double discriminant = b * b - a * c;
    CubicTurns turns;
    if (!(discriminant > 0)) return turns;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const auto [first, second] = std::minmax({q / a, c / q});  // infinite if a = 0: not kept
    for (const double root : {first, second}) {
        if (!(root > turns.t[turns.count - 1] && root < 1)) continue;
        turns.t[turns.count] = root;
        turns.t[++turns.count] = 1;
    }
    return turns;
}

// Newton's method in a bracket, which is bisected if a step would leave it or shrinks it too
// slowly. The last step's error is less than a rounding of t.
double solve_monotone(const Cubic& cubic, double value, double from, double to) {
    Cubic shifted = cubic;
    shifted.c[0] -= value;
    double below = from, above = to;  // bracket: the shifted cubic is < 0, and > 0, there
    const double at_from = shifted(from), at_to = shifted(to);
    if (at_from > at_to) std::swap(below, above);
    double t = from + (to - from) * (at_from / (at_from - at_to));  // the root if it were linear
    if (!(t > from && t < to)) t = 0.5 * (from + to);
    double step = std::abs(to - from), previous_step = step;
    const double bend = std::abs(cubic.c[2]) + 3 * std::abs(cubic.c[3]);
    for (int i = 0; i < most_newton_steps; ++i) {
        const double f = shifted(t), slope = shifted.slope(t);
        if (f == 0) return t;
        (f < 0 ? below : above) = t;
        const double newton = t - f / slope;
        const bool inside = newton > std::min(below, above) && newton < std::max(below, above);
        const bool fast = std::abs(2 * f) <= std::abs(previous_step * slope);
        const bool by_newton = inside && fast;
        const double next = by_newton ? newton : 0.5 * (below + above);
        previous_step = step;
        step = std::abs(next - t);
        t = next;
        const double rounding = root_precision * std::abs(t);
        const double bent = bend / std::abs(slope) * step;
        const bool straight = bent * step <= rounding && 8 * bent <= 1;
        if (step <= rounding || (by_newton && straight)) break;
    }
    return t;
}

Cubic restricted(const Cubic& cubic, double from, double to, double start, double end) {
    const double h = to - from;
    Cubic inside;
    inside.c[0] = start;
    inside.c[1] = cubic.slope(from) * h;
    inside.c[2] = (cubic.c[2] + 3 * cubic.c[3] * from) * h * h;
    inside.c[3] = cubic.c[3] * h * h * h;
    inside.c[1] += (end - start) - (inside.c[1] + inside.c[2] + inside.c[3]);
    return inside;
}

LAMINA_EXPORT(append_pieces_of);
LAMINA_EXPORT(append_linear_pieces_of);

void append_pieces(const SegmentBatch& segments, const TransferIntervals& transfer,
                   double error_per_length, PieceBatch& pieces) {
    LAMINA_DISPATCH(append_pieces_of)
    (segments, transfer.columns(), error_per_length, pieces);
}

void append_linear_pieces(const LinearSegments& segments, const IntervalColumns& intervals,
                          LinearPieces& pieces) {
    LAMINA_DISPATCH(append_linear_pieces_of)(segments, intervals, pieces);
}

}  // namespace lamina
#endif
