// SPDX-License-Identifier: Apache-2.0
#include "reference/cell_walk.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "reference/cell_walk.cpp"
#include "simd/foreach_target.h"

#include "reference/cut-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN
namespace reference {

constexpr auto block_edge = static_cast<double>(VisibleCells::edge);

// Returns the bits with the numbers `place`, in an array of 64-bit words.
LAMINA_INLINE DoubleMask bits_at(const std::uint64_t* words, Long place) {
    const Word64 bits = bits_as<Word64>(place);  // shifts of unsigned numbers are quicker
    const Word64 word = gather(words, bits_as<Long>(shift_right<6>(bits)));
    return (shift_right(word, bits & 63u) & 1u) == 1u;
}

// One axis of CellLanes, for as many lanes as a vector has.
class AxisLanes {
  public:
    LAMINA_INLINE AxisLanes(const CellLanes::Axis& axis, std::size_t i)
        : entry_(load<Double>(axis.entry.data() + i)),
          direction_(load<Double>(axis.direction.data() + i)),
          inverse_(load<Double>(axis.inverse.data() + i)),
          last_cell_(load<Double>(axis.last_cell.data() + i)),
          cell_(load<Double>(axis.cell.data() + i)),
          crossing_(load<Double>(axis.crossing.data() + i)),
          falls_(inverse_ < 0),
          step_(select(falls_, Double(-1), 1)),
          ahead_(select(falls_, Double(0), 1)),
          block_(block_of(cell_)),
          next_block_cell_(next_block_cell()) {}

    LAMINA_INLINE void put(CellLanes::Axis& axis, std::size_t i) const {
        store(cell_, axis.cell.data() + i);
        store(crossing_, axis.crossing.data() + i);
    }

    LAMINA_INLINE Double cell() const { return cell_; }
    LAMINA_INLINE Double crossing() const { return crossing_; }
    LAMINA_INLINE Double block() const { return block_; }
    LAMINA_INLINE Double leaving() const { return leaving_; }
    // Returns the cell's place in its block along this axis, 0 to edge - 1.
    LAMINA_INLINE Double place_in_block() const { return cell_ - first_cell(); }
    // Returns by how much a step changes a bit's number. `above`: the change of a step upwards.
    LAMINA_INLINE Long stride(std::int64_t above) const {
        return select(falls_, Long(-above), above);
    }

    // Steps to the next cell in some lanes. Returns those of them that leave their block.
    LAMINA_INLINE DoubleMask next_cell(DoubleMask lanes) {
        cell_ = select(lanes, cell_ + step_, cell_);
        crossing_ = select(lanes, next_crossing(), crossing_);
        return lanes & (cell_ == next_block_cell_);
    }

    // Finds the blocks of the cells, and the parameters at which the chords leave the blocks.
    LAMINA_INLINE void begin_blocks() {
        block_ = block_of(cell_);
        leaving_ = next_leaving();
    }
    LAMINA_INLINE void next_block(DoubleMask lanes) {
        block_ = select(lanes, block_ + step_, block_);
        leaving_ = select(lanes, next_leaving(), leaving_);
    }

    // Sets the cells of some lanes to those at the parameter `from`, inside the lanes' blocks.
    LAMINA_INLINE void find_cell(DoubleMask lanes, Double from) {
        const Double first = first_cell(), last = first + (block_edge - 1);
        const Double lo = max(first, select(falls_, last_cell_, cell_));
        const Double hi = min(last, select(falls_, cell_, last_cell_));
        const Double nearest = select(falls_, hi, lo);
        // The rounded place may be a cell early, which pass_cells() steps over, but not late. So go
        // back while the crossing into the cell, computed as in CellWalk, lies behind `from`.
        const Double place = floor(fma(from, direction_, entry_));
        Double cell = clamp(place, lo, hi);
        while (true) {
            const Double into = crossing_of(cell + 1 - ahead_);
            const DoubleMask later = lanes & ((cell != nearest) & (into > from));
            if (none_of(later)) break;
            cell = select(later, cell - step_, cell);
        }
        cell_ = select(lanes, cell, cell_);
        crossing_ = select(lanes, next_crossing(), crossing_);
        next_block_cell_ = next_block_cell();
    }

  private:
    LAMINA_INLINE static Double block_of(Double cell) {
        return floor((cell + 1) * (1 / block_edge));
    }
    LAMINA_INLINE Double first_cell() const { return fms(block_, block_edge, 1); }
    LAMINA_INLINE Double next_block_cell() const {
        const Double first = first_cell();
        return select(falls_, first - 1, first + block_edge);
    }
    LAMINA_INLINE Double crossing_of(Double plane) const { return (plane - entry_) * inverse_; }
    LAMINA_INLINE Double next_crossing() const {
        return select(cell_ == last_cell_, Double(INFINITY), crossing_of(cell_ + ahead_));
    }
    LAMINA_INLINE Double next_leaving() const {
        const Double plane = fms(block_ + ahead_, block_edge, 1);
        return select(block_ == block_of(last_cell_), Double(INFINITY), crossing_of(plane));
    }

    Double entry_, direction_, inverse_, last_cell_;
    Double cell_, crossing_;
    DoubleMask falls_;     // lanes whose chord runs down the axis
    Double step_, ahead_;  // the next cell is cell_ + step_, behind the plane cell_ + ahead_
    Double block_, next_block_cell_;  // number of the cell's block; first cell behind the block
    Double leaving_ = 0;  // parameter at which the chord leaves the block along this axis
};

// The lanes that step along x, y and z: each along the axis of the least of its three crossings.
struct AxisMasks {
    DoubleMask x, y, z;

    LAMINA_INLINE AxisMasks(Double at_x, Double at_y, Double least, DoubleMask lanes) {
        x = lanes & (at_x == least);
        y = without(lanes & (at_y == least), x);
        z = without(lanes, x | y);
    }
};

class ChordWalk {
  public:
    LAMINA_INLINE ChordWalk(CellLanes& lanes, std::size_t first, const VisibleCells& visible,
                            CellBatch* const* batches)
        : lanes_(lanes),
          first_(first),
          visible_(visible),
          batches_(batches + first),
          x_(lanes.axes[0], first),
          y_(lanes.axes[1], first),
          z_(lanes.axes[2], first),
          from_(load<Double>(lanes.from.data() + first)),
          length_(load<Double>(lanes.length.data() + first)),
          walking_(mask_of_bits<DoubleMask>(lanes.walking >> first)),
          in_block_(walking_ & mask_of_bits<DoubleMask>(lanes.in_block >> first)),
          place_(place_of_cell()) {}

    LAMINA_INLINE LaneSet run() {
        const LaneSet begun = bits_of(walking_) << first_;
        const Long stride_x = x_.stride(1), stride_y = y_.stride(VisibleCells::edge);
        const Long stride_z = z_.stride(VisibleCells::edge * VisibleCells::edge);
        LaneSet complete = 0;
        while (true) {
            find_blocks();
            if (none_of(in_block_)) break;
            do {
                complete = pass_cells(stride_x, stride_y, stride_z);
            } while (complete == 0 && most_are_in_blocks());
            if (complete != 0 || bits_of(walking_) << first_ != begun) break;
        }
        x_.put(lanes_.axes[0], first_);
        y_.put(lanes_.axes[1], first_);
        z_.put(lanes_.axes[2], first_);
        store(from_, lanes_.from.data() + first_);
        const LaneSet walking = bits_of(walking_) << first_;
        lanes_.walking = (lanes_.walking & ~begun) | walking;
        lanes_.in_block = (lanes_.in_block & ~begun) | bits_of(in_block_) << first_;
        return (begun & ~walking) | complete << first_;
    }

  private:
    // Tells whether enough lanes are in blocks; if not, finding blocks for the others is quicker.
    LAMINA_INLINE bool most_are_in_blocks() const {
        return 4 * count_of(in_block_) > count_of(walking_);
    }

    // Moves lanes that are in no visible block over invisible blocks to the next visible one.
    LAMINA_INLINE void find_blocks() {
        DoubleMask outside = without(walking_, in_block_);
        if (none_of(outside)) return;
        const DoubleMask inside = in_block_;
        x_.begin_blocks();
        y_.begin_blocks();
        z_.begin_blocks();
        while (true) {
            const DoubleMask shown = bits_at(visible_.blocks(), block_bit());
            in_block_ = in_block_ | (outside & shown);
            outside = without(outside, shown);
            if (none_of(outside)) break;
            const Double to = min(x_.leaving(), min(y_.leaving(), z_.leaving()));
            const DoubleMask goes_on = outside & (to < length_);
            walking_ = without(walking_, without(outside, goes_on));
            outside = goes_on;
            from_ = select(outside, max(from_, to), from_);
            const AxisMasks along(x_.leaving(), y_.leaving(), to, outside);
            x_.next_block(along.x);
            y_.next_block(along.y);
            z_.next_block(along.z);
        }
        const DoubleMask found = without(in_block_, inside);
        x_.find_cell(found, from_);
        y_.find_cell(found, from_);
        z_.find_cell(found, from_);
        place_ = select(found, place_of_cell(), place_);
    }

    // Appends the cells of lanes in blocks and steps on. Returns the lanes with complete batches.
    LAMINA_INLINE LaneSet pass_cells(Long stride_x, Long stride_y, Long stride_z) {
        const Double least = min(x_.crossing(), min(y_.crossing(), z_.crossing()));
        const Double to = min(least, length_);
        const DoubleMask shown = bits_at(visible_.cells(), place_) & (in_block_ & (from_ < to));
        const LaneSet complete = append(shown, to);
        const DoubleMask goes_on = in_block_ & (least < length_);
        walking_ = without(walking_, without(in_block_, goes_on));
        from_ = select(goes_on, max(from_, to), from_);
        const AxisMasks along(x_.crossing(), y_.crossing(), least, goes_on);
        const DoubleMask leave_x = x_.next_cell(along.x), leave_y = y_.next_cell(along.y);
        const DoubleMask leave_z = z_.next_cell(along.z);
        in_block_ = without(goes_on, leave_x | (leave_y | leave_z));
        const Long stride = select(along.x, stride_x, select(along.y, stride_y, stride_z));
        place_ = select(in_block_, place_ + stride, place_);
        return complete;
    }

    LAMINA_INLINE LaneSet append(DoubleMask lanes, Double to) const {
        const LaneSet shown = bits_of(lanes);
        if (shown == 0) return 0;
        alignas(64) double begins[longest_vector], ends[longest_vector];
        alignas(64) std::int64_t cells[3][longest_vector];
        store(from_, begins);
        store(to, ends);
        store(to_long(x_.cell()), cells[0]);
        store(to_long(y_.cell()), cells[1]);
        store(to_long(z_.cell()), cells[2]);
        LaneSet complete = 0;
        for_each_lane(shown, [&](std::size_t lane) LAMINA_LAMBDA {
            CellBatch& batch = *batches_[lane];
            batch.add({cells[0][lane], cells[1][lane], cells[2][lane]}, begins[lane], ends[lane]);
            if (batch.complete()) complete |= lane_bit(lane);
        });
        return complete;
    }

    LAMINA_INLINE Long block_bit() const {
        return to_long(fma(line_of_block(), static_cast<double>(visible_.line_bits()), x_.block()));
    }
    LAMINA_INLINE Long place_of_cell() const {
        const Double block =
            fma(line_of_block(), static_cast<double>(visible_.count()[0]), x_.block());
        const Double slice = fma(block, block_edge, z_.place_in_block());
        const Double row = fma(slice, block_edge, y_.place_in_block());
        return to_long(fma(row, block_edge, x_.place_in_block()));
    }
    LAMINA_INLINE Double line_of_block() const {
        return fma(z_.block(), static_cast<double>(visible_.count()[1]), y_.block());
    }

    CellLanes& lanes_;
    std::size_t first_;
    const VisibleCells& visible_;
    CellBatch* const* batches_;
    AxisLanes x_, y_, z_;
    Double from_, length_;  // the chord's parameter at which it enters the cell, and its length
    DoubleMask walking_, in_block_;
    Long place_;  // number of the cell's bit in VisibleCells::cells()
};

}  // namespace reference

inline LaneSet walk_lanes_of(CellLanes& lanes, const VisibleCells& visible,
                             CellBatch* const* batches) {
    using namespace reference;
    LaneSet done = 0;
    for (std::size_t i = 0; i < CellLanes::width; i += Double::lanes)
        done |= ChordWalk(lanes, i, visible, batches).run();
    return done;
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(walk_lanes_of);

void enter_cells(CellLanes& lanes, std::size_t lane, const GridAxes& grid, const Chord& chord) {
    for (int axis = 0; axis < 3; ++axis) {
        const double p = chord.entry[axis], d = chord.direction[axis];
        const AxisStart start(grid.lowest[axis], grid.highest[axis], p, d);
        CellLanes::Axis& rows = lanes.axes[axis];
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
    return LAMINA_DISPATCH(walk_lanes_of)(lanes, visible, batches.data());
}

}  // namespace lamina
#endif
