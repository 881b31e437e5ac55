// SPDX-License-Identifier: Apache-2.0
#include "reference/cell_lanes.h"

#include "reference/axis_start.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/cell_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After highway.h, which it needs for each target.
#include "reference/interval_search-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace reference {

constexpr auto block_edge = static_cast<double>(VisibleCells::edge);

// Returns the bits at places of words, 64 a word.
HWY_INLINE Mask bits_at(const std::uint64_t* words, Numbers place) {
    const hn::RebindToUnsigned<NumberLanes> u;
    const auto bits = hn::BitCast(u, place);  // shifts of unsigned numbers are quicker
    const auto word =
        hn::GatherIndex(u, words, hn::BitCast(NumberLanes(), hn::ShiftRight<6>(bits)));
    const auto shift = hn::And(bits, hn::Set(u, 63));
    const auto bit = hn::And(hn::Shr(word, shift), hn::Set(u, 1));
    return hn::RebindMask(Lanes(), hn::Eq(bit, hn::Set(u, 1)));
}

HWY_INLINE Numbers integer(Doubles whole) {
    return hn::ConvertTo(NumberLanes(), whole);
}

HWY_INLINE Mask mask_of(LaneSet set, std::size_t first) {
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(set >> first)};
    return hn::LoadMaskBits(Lanes(), bits);
}

// One axis of a vector of chords.
class AxisLanes {
  public:
    HWY_INLINE AxisLanes(const CellLanes::Axis& axis, std::size_t i)
        : entry_(hn::Load(Lanes(), axis.entry.data() + i)),
          direction_(hn::Load(Lanes(), axis.direction.data() + i)),
          inverse_(hn::Load(Lanes(), axis.inverse.data() + i)),
          last_cell_(hn::Load(Lanes(), axis.last_cell.data() + i)),
          cell_(hn::Load(Lanes(), axis.cell.data() + i)),
          crossing_(hn::Load(Lanes(), axis.crossing.data() + i)),
          falls_(hn::Lt(inverse_, hn::Zero(Lanes()))),
          step_(hn::IfThenElse(falls_, number(-1), number(1))),
          ahead_(hn::IfThenElse(falls_, hn::Zero(Lanes()), number(1))),
          block_(block_of(cell_)),
          next_block_cell_(next_block_cell()) {}

    HWY_INLINE void store(CellLanes::Axis& axis, std::size_t i) const {
        hn::Store(cell_, Lanes(), axis.cell.data() + i);
        hn::Store(crossing_, Lanes(), axis.crossing.data() + i);
    }

    HWY_INLINE Doubles cell() const { return cell_; }
    HWY_INLINE Doubles crossing() const { return crossing_; }
    HWY_INLINE Doubles block() const { return block_; }
    HWY_INLINE Doubles leaving() const { return leaving_; }
    // The cell's place in its block, 0 to edge - 1.
    HWY_INLINE Doubles place_in_block() const { return hn::Sub(cell_, first_cell()); }
    // How far the next cell's place lies from a cell's, if the place of its upper neighbour lies
    // `above` places from it.
    HWY_INLINE Numbers stride(std::int64_t above) const {
        return where(falls_, hn::Set(NumberLanes(), -above), hn::Set(NumberLanes(), above));
    }

    // Some lanes go on to the next cell. Returns those that leave their block.
    HWY_INLINE Mask next_cell(Mask lanes) {
        cell_ = hn::IfThenElse(lanes, hn::Add(cell_, step_), cell_);
        crossing_ = hn::IfThenElse(lanes, next_crossing(), crossing_);
        return hn::And(lanes, hn::Eq(cell_, next_block_cell_));
    }

    // Lanes that have left their block begin with the one of their cell.
    HWY_INLINE void begin_blocks() {
        block_ = block_of(cell_);
        leaving_ = next_leaving();
    }
    HWY_INLINE void next_block(Mask lanes) {
        block_ = hn::IfThenElse(lanes, hn::Add(block_, step_), block_);
        leaving_ = hn::IfThenElse(lanes, next_leaving(), leaving_);
    }

    // Some lanes go on from the cell that they had to the one that the chord has at `from`, in
    // their block.
    HWY_INLINE void find_cell(Mask lanes, Doubles from) {
        const Doubles first = first_cell(), last = hn::Add(first, number(block_edge - 1));
        const Doubles lo = hn::Max(first, hn::IfThenElse(falls_, last_cell_, cell_));
        const Doubles hi = hn::Min(last, hn::IfThenElse(falls_, cell_, last_cell_));
        const Doubles nearest = hn::IfThenElse(falls_, hi, lo);
        // A rounded place may lie in the cell before the right one: pass_cells() steps over that,
        // because the chord's part in it has no length. It must not lie in a later one, so cells
        // are told apart by the crossings of their planes, as CellWalk does.
        const Doubles place = hn::Floor(hn::MulAdd(from, direction_, entry_));
        Doubles cell = hn::Min(hn::Max(place, lo), hi);
        while (true) {
            const Doubles into = crossing_of(hn::Sub(hn::Add(cell, number(1)), ahead_));
            const Mask later = hn::And(lanes, hn::And(hn::Ne(cell, nearest), hn::Gt(into, from)));
            if (hn::AllFalse(Lanes(), later)) break;
            cell = hn::IfThenElse(later, hn::Sub(cell, step_), cell);
        }
        cell_ = hn::IfThenElse(lanes, cell, cell_);
        crossing_ = hn::IfThenElse(lanes, next_crossing(), crossing_);
        next_block_cell_ = next_block_cell();
    }

  private:
    HWY_INLINE static Doubles block_of(Doubles cell) {
        return hn::Floor(hn::Mul(hn::Add(cell, number(1)), number(1 / block_edge)));
    }
    HWY_INLINE Doubles first_cell() const {
        return hn::MulSub(block_, number(block_edge), number(1));
    }
    HWY_INLINE Doubles next_block_cell() const {
        const Doubles first = first_cell();
        return hn::IfThenElse(falls_, hn::Sub(first, number(1)),
                              hn::Add(first, number(block_edge)));
    }
    HWY_INLINE Doubles crossing_of(Doubles plane) const {
        return hn::Mul(hn::Sub(plane, entry_), inverse_);
    }
    HWY_INLINE Doubles next_crossing() const {
        return hn::IfThenElse(hn::Eq(cell_, last_cell_), hn::Inf(Lanes()),
                              crossing_of(hn::Add(cell_, ahead_)));
    }
    HWY_INLINE Doubles next_leaving() const {
        const Doubles plane = hn::MulSub(hn::Add(block_, ahead_), number(block_edge), number(1));
        return hn::IfThenElse(hn::Eq(block_, block_of(last_cell_)), hn::Inf(Lanes()),
                              crossing_of(plane));
    }

    Doubles entry_, direction_, inverse_, last_cell_;
    Doubles cell_, crossing_;
    Mask falls_;
    Doubles step_, ahead_;
    Doubles block_, next_block_cell_;
    Doubles leaving_ = hn::Zero(Lanes());  // where the chord leaves the block along this axis
};

// The lanes that go on along x, y and z: those whose crossings there are the least of the three.
struct AxisMasks {
    Mask x, y, z;

    HWY_INLINE AxisMasks(Doubles at_x, Doubles at_y, Doubles least, Mask lanes) {
        x = hn::And(lanes, hn::Eq(at_x, least));
        y = hn::AndNot(x, hn::And(lanes, hn::Eq(at_y, least)));
        z = hn::AndNot(hn::Or(x, y), lanes);
    }
};

// A vector of chords, from lane `first` on.
class ChordWalk {
  public:
    HWY_INLINE ChordWalk(CellLanes& lanes, std::size_t first, const VisibleCells& visible,
                         CellBatch* const* batches)
        : lanes_(lanes),
          first_(first),
          visible_(visible),
          batches_(batches + first),
          x_(lanes.axes[0], first),
          y_(lanes.axes[1], first),
          z_(lanes.axes[2], first),
          from_(hn::Load(Lanes(), lanes.from.data() + first)),
          length_(hn::Load(Lanes(), lanes.length.data() + first)),
          walking_(mask_of(lanes.walking, first)),
          in_block_(hn::And(walking_, mask_of(lanes.in_block, first))),
          place_(place_of_cell()) {}

    HWY_INLINE LaneSet run() {
        const LaneSet begun = set_of(walking_) << first_;
        const Numbers stride_x = x_.stride(1), stride_y = y_.stride(VisibleCells::edge);
        const Numbers stride_z = z_.stride(VisibleCells::edge * VisibleCells::edge);
        LaneSet complete = 0;
        while (true) {
            find_blocks();
            if (hn::AllFalse(Lanes(), in_block_)) break;
            do {
                complete = pass_cells(stride_x, stride_y, stride_z);
            } while (complete == 0 && most_are_in_blocks());
            if (complete != 0 || set_of(walking_) << first_ != begun) break;
        }
        x_.store(lanes_.axes[0], first_);
        y_.store(lanes_.axes[1], first_);
        z_.store(lanes_.axes[2], first_);
        hn::Store(from_, Lanes(), lanes_.from.data() + first_);
        const LaneSet walking = set_of(walking_) << first_;
        lanes_.walking = (lanes_.walking & ~begun) | walking;
        lanes_.in_block = (lanes_.in_block & ~begun) | set_of(in_block_) << first_;
        return (begun & ~walking) | complete << first_;
    }

  private:
    // With fewer it is quicker to look for blocks of the others.
    HWY_INLINE bool most_are_in_blocks() const {
        return 4 * hn::CountTrue(Lanes(), in_block_) > hn::CountTrue(Lanes(), walking_);
    }

    // Lanes that are in no block go over hidden ones to the next.
    HWY_INLINE void find_blocks() {
        Mask outside = hn::AndNot(in_block_, walking_);
        if (hn::AllFalse(Lanes(), outside)) return;
        const Mask inside = in_block_;
        x_.begin_blocks();
        y_.begin_blocks();
        z_.begin_blocks();
        while (true) {
            const Mask shown = bits_at(visible_.blocks(), block_bit());
            in_block_ = hn::Or(in_block_, hn::And(outside, shown));
            outside = hn::AndNot(shown, outside);
            if (hn::AllFalse(Lanes(), outside)) break;
            const Doubles to = hn::Min(x_.leaving(), hn::Min(y_.leaving(), z_.leaving()));
            const Mask goes_on = hn::And(outside, hn::Lt(to, length_));
            walking_ = hn::AndNot(hn::AndNot(goes_on, outside), walking_);
            outside = goes_on;
            from_ = hn::IfThenElse(outside, hn::Max(from_, to), from_);
            const AxisMasks along(x_.leaving(), y_.leaving(), to, outside);
            x_.next_block(along.x);
            y_.next_block(along.y);
            z_.next_block(along.z);
        }
        const Mask found = hn::AndNot(inside, in_block_);
        x_.find_cell(found, from_);
        y_.find_cell(found, from_);
        z_.find_cell(found, from_);
        place_ = where(found, place_of_cell(), place_);
    }

    // Appends the cells of those that are in a block, and goes on to the next ones. Returns the
    // lanes whose batches are complete.
    HWY_INLINE LaneSet pass_cells(Numbers stride_x, Numbers stride_y, Numbers stride_z) {
        const Doubles least = hn::Min(x_.crossing(), hn::Min(y_.crossing(), z_.crossing()));
        const Doubles to = hn::Min(least, length_);
        const Mask shown =
            hn::And(bits_at(visible_.cells(), place_), hn::And(in_block_, hn::Lt(from_, to)));
        const LaneSet complete = append(shown, to);
        const Mask goes_on = hn::And(in_block_, hn::Lt(least, length_));
        walking_ = hn::AndNot(hn::AndNot(goes_on, in_block_), walking_);
        from_ = hn::IfThenElse(goes_on, hn::Max(from_, to), from_);
        const AxisMasks along(x_.crossing(), y_.crossing(), least, goes_on);
        const Mask leave_x = x_.next_cell(along.x), leave_y = y_.next_cell(along.y);
        const Mask leave_z = z_.next_cell(along.z);
        in_block_ = hn::AndNot(hn::Or(leave_x, hn::Or(leave_y, leave_z)), goes_on);
        const Numbers stride = where(along.x, stride_x, where(along.y, stride_y, stride_z));
        place_ = where(in_block_, hn::Add(place_, stride), place_);
        return complete;
    }

    HWY_INLINE LaneSet append(Mask lanes, Doubles to) const {
        const LaneSet shown = set_of(lanes);
        if (shown == 0) return 0;
        alignas(64) double begins[longest_vector], ends[longest_vector];
        alignas(64) std::int64_t cells[3][longest_vector];
        hn::Store(from_, Lanes(), begins);
        hn::Store(to, Lanes(), ends);
        hn::Store(integer(x_.cell()), NumberLanes(), cells[0]);
        hn::Store(integer(y_.cell()), NumberLanes(), cells[1]);
        hn::Store(integer(z_.cell()), NumberLanes(), cells[2]);
        LaneSet complete = 0;
        for_each_lane(shown, [&](std::size_t lane) HWY_ATTR {
            CellBatch& batch = *batches_[lane];
            batch.add({cells[0][lane], cells[1][lane], cells[2][lane]}, begins[lane], ends[lane]);
            if (batch.complete()) complete |= lane_bit(lane);
        });
        return complete;
    }

    // The block's place in VisibleCells::blocks().
    HWY_INLINE Numbers block_bit() const {
        return integer(hn::MulAdd(line_of_block(),
                                  number(static_cast<double>(visible_.line_bits())), x_.block()));
    }
    // The cell's place in VisibleCells::cells().
    HWY_INLINE Numbers place_of_cell() const {
        const Doubles block = hn::MulAdd(
            line_of_block(), number(static_cast<double>(visible_.count()[0])), x_.block());
        const Doubles slice = hn::MulAdd(block, number(block_edge), z_.place_in_block());
        const Doubles row = hn::MulAdd(slice, number(block_edge), y_.place_in_block());
        return integer(hn::MulAdd(row, number(block_edge), x_.place_in_block()));
    }
    HWY_INLINE Doubles line_of_block() const {
        return hn::MulAdd(z_.block(), number(static_cast<double>(visible_.count()[1])), y_.block());
    }

    CellLanes& lanes_;
    std::size_t first_;
    const VisibleCells& visible_;
    CellBatch* const* batches_;
    AxisLanes x_, y_, z_;
    Doubles from_, length_;
    Mask walking_, in_block_;
    Numbers place_;  // the cell's, in VisibleCells::cells()
};

}  // namespace reference

// HWY_EXPORT takes functions of this namespace alone.
inline LaneSet walk_lanes_of(CellLanes& lanes, const VisibleCells& visible,
                             CellBatch* const* batches) {
    using namespace reference;
    LaneSet done = 0;
    for (std::size_t i = 0; i < CellLanes::width; i += hn::Lanes(Lanes()))
        done |= ChordWalk(lanes, i, visible, batches).run();
    return done;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(walk_lanes_of);

void enter_cells(CellLanes& lanes, std::size_t lane, const GridAxes& grid, const Chord& chord) {
    for (int axis = 0; axis < 3; ++axis) {
        const double p = chord.entry[axis], d = chord.direction[axis];
        const AxisStart start(grid.lowest[axis], grid.highest[axis], p, d);
        CellLanes::Axis& rows = lanes.axes[static_cast<std::size_t>(axis)];
        rows.entry[lane] = p;
        rows.direction[lane] = d;
        rows.inverse[lane] = start.inverse;
        rows.cell[lane] = start.cell;
        rows.last_cell[lane] = start.last_cell;
    }
    lanes.from[lane] = 0;
    lanes.length[lane] = chord.length_z;
    lanes.walking |= lane_bit(lane);
    lanes.in_block &= ~lane_bit(lane);
}

LaneSet walk_cells(CellLanes& lanes, const VisibleCells& visible,
                   const std::array<CellBatch*, CellLanes::width>& batches) {
    return HWY_DYNAMIC_DISPATCH(walk_lanes_of)(lanes, visible, batches.data());
}

}  // namespace lamina
#endif
