// SPDX-License-Identifier: Apache-2.0
// Projects up to 8 cell fragments at a time, each in one lane of vectors of doubles:
//   1. load() gathers corners, scalars and pieces of the transfer function into SetupLanes.
//   2. TetVectors does what TetProjector::project() does, and finds in which lanes it is certain.
//   3. write_records() transposes the lanes into the records.
//   4. store() sets outcomes and areas.
#include "projection/tet_setup.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "projection/tet_setup.cpp"
#include "simd/foreach_target.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "facts/drawn_range.h"
#include "optics/segment_integral.h"
#include "projection/tet_view-inl.h"

LAMINA_SIMD_BEGIN

// The planes of a tet's faces: front faces from place 0 on, the others from place 3 backwards.
struct FacePlanes {
    Double depth[4], per_column[4], per_row[4];
    Double fronts;  // number of front faces so far

    LAMINA_INLINE FacePlanes() : fronts(0), place_of_back_(3) {
        for (std::size_t place = 0; place < 4; ++place)
            depth[place] = per_column[place] = per_row[place] = 0;
    }

    LAMINA_INLINE void add(DoubleMask front, const TetView<Double>::DepthPlane& plane) {
        const Double place = select(front, fronts, place_of_back_);
        for (std::size_t i = 0; i < 4; ++i) {
            const DoubleMask here = place == static_cast<double>(i);
            depth[i] = select(here, plane.depth, depth[i]);
            per_column[i] = select(here, plane.per_column, per_column[i]);
            per_row[i] = select(here, plane.per_row, per_row[i]);
        }
        fronts += zero_unless(front, Double(1));
        place_of_back_ -= zero_if(front, Double(1));
    }

  private:
    Double place_of_back_;
};

// Sets up one vector of tets, lanes `first` and following of a SetupLanes.
class TetVectors {
  public:
    TetVectors(const TetsInView& tets, bool careful, SetupLanes& lanes, std::size_t first)
        : tets_(tets), lanes_(lanes), first_(first), careful_(careful), tet_(tets.view()) {}

    void set_up(bool cell_fragments, bool lit) {
        see();
        place_center();
        DoubleMask good = find_faces();
        good = good & find_gradient();
        if (cell_fragments) {
            set_fragment();
        } else {
            good = good & set_whole();
        }
        set_bounds();
        if (lit) {
            const DoubleMask unscaled = set_gradients();
            if (careful_) good = good & unscaled;
        }
        put_whole(lanes_.limits[2], fronts_);
        put(lanes_.good, zero_unless(good, Double(1)));
        put(lanes_.visible, zero_unless(visible_, Double(1)));
    }

  private:
    using Row = SetupLanes::Row;
    using FloatRow = SetupLanes::FloatRow;
    Double get(const Row& row) const { return load<Double>(row.data() + first_); }
    void put(Row& row, Double v) const { store(v, row.data() + first_); }
    void put(FloatRow& row, Double v) const { store_as_floats(v, row.data() + first_); }
    // Stores numbers as sums of two floats.
    void put_pair(FloatRow& high, FloatRow& low, Double v) const {
        put(high, v);
        if (careful_) put(low, v - rounded_to_float(v));
    }
    // Stores whole numbers as 32-bit integers, in the bits of floats.
    void put_whole(FloatRow& row, Double v) const { store_as_int_bits(v, row.data() + first_); }

    void see() {
        const View& view = tets_.view();
        for (std::size_t i = 0; i < 4; ++i) {
            const SeenPoints p{get(lanes_.x[i]) - view.eye.x, get(lanes_.y[i]) - view.eye.y,
                               get(lanes_.z[i]) - view.eye.z};
            const auto along = [&](const glm::dvec3& axis) LAMINA_LAMBDA {
                return dot(p, SeenPoints{axis.x, axis.y, axis.z});
            };
            seen_[i] = {along(view.right), along(view.up), along(view.forward)};
            values_[i] = get(lanes_.value[i]);
        }
    }

    void place_center() {
        const auto bounds = tet_.place_center(std::span<const SeenPoints>(seen_));
        nearest_ = bounds.nearest;
        farthest_ = bounds.farthest;
        bounds_ = {bounds.lo_x, bounds.hi_x, bounds.lo_y, bounds.hi_y};
        put(lanes_.center[0], tet_.center_x);
        put(lanes_.center[1], tet_.center_y);
        put(lanes_.center[2], tet_.center_depth);
        put(lanes_.center[3], tet_.center_z);
    }

    // Sets the bounds of the pixel centres that may be covered (pixel_bounds()).
    void set_bounds() {
        const auto first = [&](Double least)
                               LAMINA_LAMBDA { return max(ceil(least - tets_.margin - 0.5), 0); };
        const auto last = [&](Double most, int count) LAMINA_LAMBDA {
            return min(floor(most + tets_.margin - 0.5), count - 1);
        };
        const Double first_column = first(bounds_.lo_x), first_row = first(bounds_.lo_y);
        const Double last_column = last(bounds_.hi_x, tets_.view().width);
        const Double last_row = last(bounds_.hi_y, tets_.view().height);
        visible_ = (first_column <= last_column) & (first_row <= last_row);
        put_whole(lanes_.pixels[0], first_column);
        put_whole(lanes_.pixels[1], last_column);
        const int top = tets_.view().height - 1;
        put_whole(lanes_.pixels[2], top - last_row);
        put_whole(lanes_.pixels[3], top - first_row);
    }

    // Returns true if the signs are certain and, unless `careful`, float32 is good enough.
    DoubleMask find_faces() {
        Double reach = 0, size = 0, steepest = 0, rounding = 0;
        for (const SeenPoints& p : seen_) {
            reach = max(reach, largest_of(p));
            size = max(size, largest_of(p - seen_[0]));
        }
        const Double least_divisor =
            doubtful_sign * (reach * reach * (tet_.perspective() ? reach : 1));
        // The rounding errors of points, and so of edges, are a share of their distance `reach`. In
        // slivers, normals are small differences of products of edges, and suffer most.
        const Double least_across = doubtful_sign * (reach * (size * size));
        DoubleMask good = nearest_ > tets_.near_depth;
        FacePlanes planes;
        Double largest_area = 0;
        for (std::size_t face = 0; face < 4; ++face) {
            const auto [a, b, c] = corners_of_face(face);
            const SeenPoints normal = cross(b - a, c - a);
            largest_area = max(largest_area, largest_of(normal));
            const Double distance = dot(normal, a), across = dot(normal, seen_[face] - a);
            const Double divisor = tet_.divisor(normal, distance);
            good = good & ((abs(divisor) > least_divisor) & (abs(across) > least_across));
            const auto plane = tet_.plane(normal, distance, divisor);
            planes.add(divisor * across > 0, plane);
            steepest = max(steepest, abs(plane.per_column) + abs(plane.per_row));
            rounding = max(rounding, tet_.size_of(plane));
        }
        for (std::size_t place = 0; place < 4; ++place) {
            put_pair(lanes_.depth[place], lanes_.depth_low[place], planes.depth[place]);
            put_pair(lanes_.per_column[place], lanes_.per_column_low[place],
                     planes.per_column[place]);
            put_pair(lanes_.per_row[place], lanes_.per_row_low[place], planes.per_row[place]);
        }
        fronts_ = planes.fronts;
        good = good & ((fronts_ > 0) & (fronts_ < 4));
        // No longest edge exceeds 2 `size`; another factor 2 is far above the products' rounding.
        if (careful_) return good & (largest_area > 4 * least_width * (reach * size));
        const Double float_rounding = rounding * float_epsilon,
                     tolerance = float_tolerance * tet_.depth_range;
        put(lanes_.farthest, tet_.inverted(farthest_) - tet_.center_depth + tolerance);
        good = good & (float_rounding <= tolerance);
        // Outside the tet, rounding may make segments if it is not small, or depth 0 is near.
        DoubleMask bounded = 100 * float_rounding > tolerance;
        if (tet_.perspective()) bounded = bounded | (16 * steepest > abs(tet_.center_depth));
        put(lanes_.bounded, zero_unless(bounded, Double(1)));
        return good;
    }
    // Returns the corners of a face by ascending place.
    std::array<SeenPoints, 3> corners_of_face(std::size_t face) const {
        std::array<std::size_t, 3> number{face == 0 ? 1u : 0u, face <= 1 ? 2u : 1u,
                                          face == 3 ? 2u : 3u};
        std::array<SeenPoints, 3> corners{seen_[number[0]], seen_[number[1]], seen_[number[2]]};
        if (!careful_) return corners;
        std::array<Double, 3> places;
        for (std::size_t i = 0; i < 3; ++i) places[i] = get(lanes_.place[number[i]]);
        const auto sort = [&](std::size_t i, std::size_t j) LAMINA_LAMBDA {
            const DoubleMask swapped = places[i] > places[j];
            const auto sort_pair = [&](Double& low, Double& high) LAMINA_LAMBDA {
                const Double first = select(swapped, high, low);
                high = select(swapped, low, high);
                low = first;
            };
            sort_pair(places[i], places[j]);
            sort_pair(corners[i].x, corners[j].x);
            sort_pair(corners[i].y, corners[j].y);
            sort_pair(corners[i].z, corners[j].z);
        };
        sort(0, 1);
        sort(1, 2);
        sort(0, 1);
        return corners;
    }

    // Finds the scalar's gradient; returns true if it is finite.
    DoubleMask find_gradient() {
        gradient_ = gradient_of(TetSlopes<Double>(seen_), values_);
        least_ = min(min(values_[0], values_[1]), min(values_[2], values_[3]));
        largest_ = max(max(values_[0], values_[1]), max(values_[2], values_[3]));
        return largest_of(gradient_) <= 1e30 * (largest_ - least_);
    }
    SeenPoints gradient_of(const TetSlopes<Double>& slopes,
                           const std::array<Double, 4>& values) const {
        const SeenPoints numerator =
            slopes.numerator(values[1] - values[0], values[2] - values[0], values[3] - values[0]);
        if (!careful_) return scaled(numerator, 1 / slopes.determinant);
        return {numerator.x / slopes.determinant, numerator.y / slopes.determinant,
                numerator.z / slopes.determinant};
    }

    Double scalar_at(const SeenPoints& point) const {
        return values_[0] + dot(gradient_, point - seen_[0]);
    }

    // Sets the scalar as (scalar - origin) / width.
    void set_scalars(Double origin, Double width) {
        const Double scale = zero_unless(width > 0, 1 / width);
        const auto linear =
            tet_.linear((scalar_at(tet_.center()) - origin) * scale, scaled(gradient_, scale));
        for (std::size_t i = 0; i < 4; ++i) {
            const Double value = finite(linear[i]);
            put(lanes_.scalar[i], value);
            if (careful_) put(lanes_.scalar_rest[i], finite(linear[i] - rounded_to_float(value)));
        }
    }

    // Sets the components of the gradient as set_scalars() sets the scalar. Returns true if they
    // are not shortened; TetProjector rounds those that are otherwise.
    DoubleMask set_gradients() {
        const TetSlopes<Double> slopes(seen_);
        const SeenPoints from_corner = tet_.center() - seen_[0];
        Double largest = 0;
        for (const auto& corners : lanes_.gradient) {
            for (const Row& corner : corners) largest = max(largest, abs(get(corner)));
        }
        // Computed as by StoredGradients::scale_of_tet().
        constexpr double most = StoredGradients::largest_in_tet;
        const Double scale = select(largest > most, most / largest, 1);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::array<Double, 4> values;
            for (std::size_t i = 0; i < 4; ++i) values[i] = get(lanes_.gradient[axis][i]) * scale;
            const SeenPoints slope = gradient_of(slopes, values);
            const auto linear = tet_.linear(values[0] + dot(slope, from_corner), slope);
            for (std::size_t i = 0; i < 4; ++i) put(lanes_.lit[axis][i], finite(linear[i]));
        }
        return scale == 1;
    }

    // Returns true if float32 is good enough for the scalars (facts/drawn_range.h).
    DoubleMask set_whole() {
        const double origin = tets_.range.lo, width = tets_.range.hi - tets_.range.lo;
        set_scalars(origin, width);
        const Double least = (least_ - origin) / width, largest = (largest_ - origin) / width;
        put(lanes_.limits[0], least);
        put(lanes_.limits[1], largest);
        const Double most = max(-least, largest - 1);
        const DoubleMask meets = (least < 1) & (largest > 0);
        return most <= select(meets, Double(far_for_floats), farthest_normalised);
    }

    void set_fragment() {
        const Double from = get(lanes_.piece_from), to = get(lanes_.piece_to);
        const Double low = clamp(least_, from, to), high = clamp(largest_, from, to);
        if (careful_) bounds_ = bounds_between(low, high);
        set_scalars(low, high - low);
        const Cut lower = cut_at(low, from > least_, true);
        const Cut upper = cut_at(high, to < largest_, false);
        put(lanes_.cuts[0], lower.plane.depth);
        put(lanes_.cuts[1], lower.plane.per_column);
        put(lanes_.cuts[2], lower.plane.per_row);
        put(lanes_.cuts[3], upper.plane.depth);
        put(lanes_.limits[0], upper.plane.per_column);
        put(lanes_.limits[1], upper.plane.per_row);
        const auto bit = [&](DoubleMask front, std::uint32_t value)
                             LAMINA_LAMBDA { return zero_unless(front, Double(value)); };
        fronts_ += bit(lower.front, FragmentRecord::lower_cut_is_front) +
                   bit(upper.front, FragmentRecord::upper_cut_is_front);
        const Double width = to - from;
        constexpr std::size_t extinction = 3;
        Double most = 0;
        for (std::size_t channel = 0; channel < 4; ++channel) {
            const Double at_from = get(lanes_.at_from[channel]), at_to = get(lanes_.at_to[channel]);
            const auto at = [&](Double scalar) LAMINA_LAMBDA {
                const Double sum =
                    at_from * ((to - scalar) / width) + at_to * ((scalar - from) / width);
                return finite(select(at_from == at_to, at_from, sum));
            };
            const Double at_low = at(low), at_high = at(high);
            put(lanes_.low[channel], at_low);
            put(lanes_.high[channel], at_high);
            if (channel == extinction) most = max(at_low, at_high);
        }
        put(lanes_.largest_depth, longest_edge<Double>(seen_) * most);
    }

    // Bounds in window coordinates.
    struct Bounds {
        Double lo_x, hi_x, lo_y, hi_y;

        LAMINA_INLINE void add(DoubleMask here, Double x, Double y) {
            lo_x = select(here, min(lo_x, x), lo_x);
            hi_x = select(here, max(hi_x, x), hi_x);
            lo_y = select(here, min(lo_y, y), lo_y);
            hi_y = select(here, max(hi_y, y), hi_y);
        }
    };
    // Returns the bounds of the region with scalars from `low` to `high` (TetField::outline()).
    Bounds bounds_between(Double low, Double high) const {
        Bounds bounds{INFINITY, -INFINITY, INFINITY, -INFINITY};
        const auto add = [&](DoubleMask here, const SeenPoints& p) LAMINA_LAMBDA {
            const auto [x, y] = tet_.in_window(p);
            bounds.add(here, x, y);
        };
        for (std::size_t i = 0; i < 4; ++i) {
            const Double from = values_[i];
            add((from >= low) & (from <= high), seen_[i]);
            for (std::size_t j = i + 1; j < 4; ++j) {
                const Double to = values_[j];
                for (const Double level : {low, high}) {
                    const DoubleMask crosses =
                        ((from < level) & (to > level)) | ((from > level) & (to < level));
                    if (none_of(crosses)) continue;
                    const Double share = (level - from) / (to - from);
                    const SeenPoints edge = scaled(seen_[j] - seen_[i], share);
                    add(crosses, {seen_[i].x + edge.x, seen_[i].y + edge.y, seen_[i].z + edge.z});
                }
            }
        }
        return bounds;
    }

    // A plane of constant scalar, as in FragmentRecord.
    struct Cut {
        TetView<Double>::DepthPlane plane;
        DoubleMask front;
    };
    Cut cut_at(Double level, DoubleMask is_cut, bool lower) const {
        const auto found = tet_.level(gradient_, level - scalar_at({0, 0, 0}));
        const DoubleMask front = lower ? found.front : !found.front;
        return {
            {select(is_cut, found.plane.depth, -beyond_all),
             zero_unless(is_cut, found.plane.per_column), zero_unless(is_cut, found.plane.per_row)},
            front | !is_cut};
    }

    const TetsInView& tets_;
    SetupLanes& lanes_;
    std::size_t first_;
    bool careful_;
    TetView<Double> tet_;
    std::array<SeenPoints, 4> seen_;
    std::array<Double, 4> values_;
    Double fronts_, nearest_, farthest_, least_, largest_;
    SeenPoints gradient_;
    Bounds bounds_;
    DoubleMask visible_;
};

// Writes a group's numbers `offset` bytes into the records, as bytes because some are integers.
template <std::size_t offset, typename Record>
LAMINA_INLINE void write_group(const SetupLanes::Group& rows, std::size_t count, Record* records) {
    static_assert(offset % 16 == 0 && sizeof(Record) % 16 == 0);
    constexpr std::size_t together = 4;
    for (std::size_t first = 0; first < count; first += together) {
        Float4 columns[together];
        for (std::size_t i = 0; i < together; ++i)
            columns[i] = load<Float4>(rows[i].data() + first);
        transpose(columns);
        for (std::size_t i = 0; i < std::min(together, count - first); ++i) {
            alignas(16) float group[together];
            store(columns[i], group);
            auto* const record = reinterpret_cast<std::byte*>(records + first + i);
            std::memcpy(record + offset, group, sizeof(group));
        }
    }
}

// The groups have the layout of four numbers side by side in these types.
static_assert(sizeof(PixelArea) == 16 && std::is_base_of_v<PixelArea, CoveredArea>);
static_assert(sizeof(GradientRecord::Component) == 16);
static_assert(offsetof(SeenTet, center_z) == offsetof(SeenTet, center) + 12);
static_assert(offsetof(SeenTet, scalar_per_row) == offsetof(SeenTet, scalar) + 12);
static_assert(offsetof(TetRecord, fronts) == offsetof(TetRecord, least) + 8);
static_assert(offsetof(TetRecord, number) == offsetof(TetRecord, least) + 12);
static_assert(offsetof(FragmentRecord, upper_cut_per_column) == offsetof(TetRecord, least));
static_assert(offsetof(FragmentRecord, fronts) == offsetof(TetRecord, fronts));
static_assert(offsetof(FragmentRecord, number) == offsetof(TetRecord, number));
static_assert(offsetof(FragmentRecord, upper_cut) == offsetof(FragmentRecord, lower_cut) + 12);

LAMINA_INLINE void write_records(const SetupLanes& lanes, bool cell_fragments, bool careful,
                                 std::size_t count, SilhouetteRecord* records) {
    write_group<offsetof(SeenTet, depth)>(lanes.depth, count, records);
    write_group<offsetof(SeenTet, depth_per_column)>(lanes.per_column, count, records);
    write_group<offsetof(SeenTet, depth_per_row)>(lanes.per_row, count, records);
    write_group<offsetof(SeenTet, center)>(lanes.center, count, records);
    write_group<offsetof(SeenTet, scalar)>(lanes.scalar, count, records);
    write_group<offsetof(TetRecord, least)>(lanes.limits, count, records);
    if (careful) {
        constexpr std::size_t low = offsetof(SeenTet::Pairs, low);
        write_group<offsetof(SeenTet, depth) + low>(lanes.depth_low, count, records);
        write_group<offsetof(SeenTet, depth_per_column) + low>(lanes.per_column_low, count,
                                                               records);
        write_group<offsetof(SeenTet, depth_per_row) + low>(lanes.per_row_low, count, records);
        write_group<offsetof(TetRecord, scalar_rest)>(lanes.scalar_rest, count, records);
    }
    if (!cell_fragments) return;
    write_group<offsetof(FragmentRecord, lower_cut)>(lanes.cuts, count, records);
    write_group<offsetof(FragmentRecord, low)>(lanes.low, count, records);
    write_group<offsetof(FragmentRecord, high)>(lanes.high, count, records);
}

LAMINA_INLINE void write_gradients(const SetupLanes& lanes, std::size_t count,
                                   GradientRecord* lit) {
    constexpr std::size_t component = sizeof(GradientRecord::Component);
    write_group<0>(lanes.lit[0], count, lit);
    write_group<component>(lanes.lit[1], count, lit);
    write_group<2 * component>(lanes.lit[2], count, lit);
}

// Sets up all vectors; writes `count` records, gradients unless `lit` is null, and areas' pixels.
void set_up_vectors(const TetsInView& tets, bool cell_fragments, bool careful, SetupLanes& lanes,
                    std::size_t count, SilhouetteRecord* records, GradientRecord* lit,
                    CoveredArea* areas) {
    for (std::size_t first = 0; first < TetSetup::most_cell_fragments; first += Double::lanes)
        TetVectors(tets, careful, lanes, first).set_up(cell_fragments, lit != nullptr);
    write_records(lanes, cell_fragments, careful, count, records);
    if (lit != nullptr) write_gradients(lanes, count, lit);
    write_group<0>(lanes.pixels, count, areas);
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(set_up_vectors);

namespace {

std::array<std::size_t, 4> corners_of(const Tet& tet) {
    std::array<std::size_t, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) corners[i] = static_cast<std::size_t>(tet[i]);
    return corners;
}

// Returns a tet's corners, sorted by place: all tets around a face take its corners in one order.
std::array<std::size_t, 4> sorted_corners(const TetMesh& mesh, const Tet& tet) {
    std::array<std::size_t, 4> corners = corners_of(tet);
    constexpr int bits = 32;  // if there are copies, the place stands above the corner's
    for (std::size_t i = 0; i < 4 && mesh.has_copies(); ++i)
        corners[i] |= static_cast<std::size_t>(mesh.place(tet[i])) << bits;
    const auto sort = [&](std::size_t i, std::size_t j) {
        const std::size_t low = std::min(corners[i], corners[j]);
        corners[j] = std::max(corners[i], corners[j]);
        corners[i] = low;
    };
    sort(0, 1);
    sort(2, 3);
    sort(0, 2);
    sort(1, 3);
    sort(1, 2);
    for (std::size_t& corner : corners) corner &= (std::size_t{1} << bits) - 1;
    return corners;
}

// Prefetches the corners of the next tets, and the tets after these, which lie scattered in memory.
// Inlined because GCC 12 drops calls of a function that only prefetches.
LAMINA_INLINE void prefetch(const TetsInView& tets, std::span<const CellFragment> next) {
    constexpr std::size_t most = TetSetup::most_cell_fragments;
    const auto all = tets.mesh.tets();
    for (std::size_t i = 0; i < std::min(next.size(), most); ++i) {
        for (const std::int32_t corner : all[static_cast<std::size_t>(next[i].tet)]) {
            __builtin_prefetch(&tets.mesh.points()[static_cast<std::size_t>(corner)]);
            __builtin_prefetch(&tets.scalar[static_cast<std::size_t>(corner)]);
        }
    }
    for (std::size_t i = most; i < std::min(next.size(), 2 * most); ++i)
        __builtin_prefetch(&all[static_cast<std::size_t>(next[i].tet)]);
}

// Fills all lanes; those without a cell fragment repeat the last one.
void load(const TetsInView& tets, std::span<const CellFragment> cell_fragments, bool careful,
          bool lit, SetupLanes& lanes) {
    const auto all = tets.mesh.tets();
    for (std::size_t lane = 0; lane < TetSetup::most_cell_fragments; ++lane) {
        const CellFragment& cell_fragment =
            cell_fragments[std::min(lane, cell_fragments.size() - 1)];
        const Tet& tet = all[static_cast<std::size_t>(cell_fragment.tet)];
        const auto corners = careful ? corners_of(tet) : sorted_corners(tets.mesh, tet);
        for (std::size_t i = 0; i < 4; ++i) {
            if (careful) lanes.place[i][lane] = tets.mesh.place(tet[i]);
            const glm::dvec3& point = tets.mesh.points()[corners[i]];
            lanes.x[i][lane] = point.x;
            lanes.y[i][lane] = point.y;
            lanes.z[i][lane] = point.z;
            lanes.value[i][lane] = tets.scalar[corners[i]];
            for (int axis = 0; axis < 3 && lit; ++axis)
                lanes.gradient[static_cast<std::size_t>(axis)][i][lane] =
                    static_cast<double>(tets.gradients[corners[i]][axis]);
        }
        lanes.limits[3][lane] =
            std::bit_cast<float>(cell_fragment_number(cell_fragment, all.size()));
        const LinearPiece* const piece = tets.piece_of(cell_fragment);
        if (piece == nullptr) continue;
        lanes.piece_from[lane] = piece->from;
        lanes.piece_to[lane] = piece->to;
        for (int channel = 0; channel < 3; ++channel) {
            lanes.at_from[static_cast<std::size_t>(channel)][lane] = piece->at_from.color[channel];
            lanes.at_to[static_cast<std::size_t>(channel)][lane] = piece->at_to.color[channel];
        }
        lanes.at_from[3][lane] = piece->at_from.extinction;
        lanes.at_to[3][lane] = piece->at_to.extinction;
    }
}

void store(std::span<const CellFragment> cell_fragments, const SetupLanes& lanes, bool careful,
           int image_rows, const SilhouetteRecord* records, TetSetup& result) {
    using Outcome = TetSetup::Outcome;
    for (std::size_t lane = 0; lane < cell_fragments.size(); ++lane) {
        Outcome& outcome = result.outcomes[lane];
        outcome = lanes.good[lane] == 0      ? Outcome::needs_care
                  : lanes.visible[lane] == 0 ? Outcome::invisible
                                             : Outcome::done;
        if (outcome != Outcome::done) continue;
        const bool any_depth = careful || cell_fragments[lane].piece == CellFragment::whole;
        const double depth = any_depth ? INFINITY : lanes.largest_depth[lane];
        CoveredArea& area = result.areas[lane];
        area.careful = careful;
        area.depth = depth <= faint_depth  ? DepthBound::faint
                     : depth <= thin_depth ? DepthBound::thin
                                           : DepthBound::any;
        area.bounded = careful || lanes.bounded[lane] != 0;
        area.farthest = careful ? INFINITY : static_cast<float>(lanes.farthest[lane]);
        area.outline = outline_of(records[lane], area, image_rows);
    }
}

}  // namespace

void set_up_tets(const TetsInView& tets, std::span<const CellFragment> cell_fragments,
                 std::span<const CellFragment> next, bool careful, SilhouetteRecord* records,
                 GradientRecord* lit, TetSetup& result) {
    SetupLanes lanes;
    prefetch(tets, next);
    load(tets, cell_fragments, careful, lit != nullptr, lanes);
    const bool pieces = cell_fragments[0].piece != CellFragment::whole;
    LAMINA_DISPATCH(set_up_vectors)
    (tets, pieces, careful, lanes, cell_fragments.size(), records, lit, result.areas.data());
    store(cell_fragments, lanes, careful, tets.view().height, records, result);
}

}  // namespace lamina
#endif
