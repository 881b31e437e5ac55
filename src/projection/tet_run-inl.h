// SPDX-License-Identifier: Apache-2.0
// Where the rays of some pixels are inside a cell fragment. This is the vector form of
// shaders/projection/silhouette.glsl, which gives the reasons.
#if defined(LAMINA_PROJECTION_TET_RUN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_RUN_INL_H_
#undef LAMINA_PROJECTION_TET_RUN_INL_H_
#else
#define LAMINA_PROJECTION_TET_RUN_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/tile_fragments.h"
#include "tiles/arithmetic-inl.h"
#include "tiles/doubles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct InsideSpan {
    V enter, leave;
};

// The run of a ray through a cell fragment. Scalars are normalised as the record says. A ray that
// misses the cell fragment has equal scalars and length 0.
template <class V>
struct TetRun {
    V front, back, world_length;
};

// A linear function of the pixel: its value at a column, counted from the record's center, and its
// change from row to row. It is rounded as in the shader.
template <class D>
HWY_INLINE hn::Vec<D> at_column(D d, float at_center, float per_column, hn::Vec<D> column) {
    return hn::Add(hn::Set(d, at_center), hn::Mul(hn::Set(d, per_column), column));
}
template <class D>
HWY_INLINE hn::Vec<D> at_row(D d, hn::Vec<D> value, float per_row, hn::Vec<D> row) {
    return hn::Add(value, hn::Mul(hn::Set(d, per_row), row));
}

// The entry is the largest depth on front faces, which come first; the exit is the least depth on
// the other faces.
template <class V>
HWY_INLINE InsideSpan<V> order_depths(std::uint32_t fronts, V d0, V d1, V d2, V d3) {
    switch (fronts) {
        case 1:
            return {d0, hn::Min(hn::Min(d1, d2), d3)};
        case 2:
            return {hn::Max(d0, d1), hn::Min(d2, d3)};
        default:
            return {hn::Max(hn::Max(d0, d1), d2), d3};
    }
}

template <class V>
HWY_INLINE InsideSpan<V> order_depths_from(std::uint32_t fronts, V nearest, V d0, V d1, V d2,
                                           V d3) {
    if (fronts == 0) return {nearest, hn::Min(hn::Min(d0, d1), hn::Min(d2, d3))};
    const InsideSpan<V> span = order_depths(fronts, d0, d1, d2, d3);
    return {hn::Max(nearest, span.enter), span.leave};
}

// Depths on faces in float32.
template <class D>
class PlainDepths {
  public:
    using V = hn::Vec<D>;
    HWY_INLINE PlainDepths(D, const TetFragments&, const TetRecord& record)
        : record_(record), fronts_(record.fronts & 7u) {}

    struct AtColumns {
        V d0, d1, d2, d3;
    };
    HWY_INLINE AtColumns at_columns(D d, V column) const {
        const auto start = [&](std::size_t face) HWY_ATTR {
            return at_column(d, record_.depth.high[face], record_.depth_per_column.high[face],
                             column);
        };
        return {start(0), start(1), start(2), start(3)};
    }
    HWY_INLINE InsideSpan<V> at(D d, const AtColumns& start, V row) const {
        const auto& per_row = record_.depth_per_row.high;
        return order_depths(
            fronts_, at_row(d, start.d0, per_row[0], row), at_row(d, start.d1, per_row[1], row),
            at_row(d, start.d2, per_row[2], row), at_row(d, start.d3, per_row[3], row));
    }

  private:
    const TetRecord& record_;
    std::uint32_t fronts_;
};

// The same in double precision, for faces that are seen nearly edge-on, for the near plane, and
// where the eye is inside.
template <class D>
class CarefulDepths {
  public:
    using V = hn::Vec<D>;
    HWY_INLINE CarefulDepths(D, const TetFragments& fragments, const TetRecord& record)
        : fragments_(fragments), record_(record) {}

    using AtColumns = Doubles<D>;
    HWY_INLINE AtColumns at_columns(D d, V column) const {
        const typename Doubles<D>::Tag dd;
        const auto moved = [&](auto place) HWY_ATTR {
            // The ray perturbation moves the ray in space. Its component along the ray does not
            // count.
            return move(dd, place, record_.center[0], fragments_.image_middle.x,
                        fragments_.ray_perturbation.x);
        };
        return each_half(moved, to_doubles(d, column));
    }
    HWY_INLINE InsideSpan<V> at(D d, const AtColumns& columns, V row) const {
        const typename Doubles<D>::Tag dd;
        const auto moved = [&](auto place) HWY_ATTR {
            return move(dd, place, record_.center[1], fragments_.image_middle.y,
                        fragments_.ray_perturbation.y);
        };
        const Doubles<D> rows = each_half(moved, to_doubles(d, row));
        const auto depth = [&](std::size_t face) HWY_ATTR {
            return to_floats(d, Doubles<D>{plane(dd, face, columns.low, rows.low),
                                           plane(dd, face, columns.high, rows.high)});
        };
        const auto nearest = hn::Set(d, fragments_.near_depth - record_.center_depth);
        return order_depths_from(record_.fronts & 7u, nearest, depth(0), depth(1), depth(2),
                                 depth(3));
    }

    // A double for each of half of the lanes: where rays are inside, and the scalar's ends there,
    // not clamped. `column`, `row`: from the record's center.
    template <class VD>
    struct ExactSpan {
        VD length;  // along z
        VD front, back;
    };
    template <class VD>
    HWY_INLINE ExactSpan<VD> exact_at(bool perspective, VD column, VD row) const {
        const typename Doubles<D>::Tag dd;
        const VD x = move(dd, column, record_.center[0], fragments_.image_middle.x,
                          fragments_.ray_perturbation.x),
                 y = move(dd, row, record_.center[1], fragments_.image_middle.y,
                          fragments_.ray_perturbation.y);
        const auto set = [&](float value) { return hn::Set(dd, static_cast<double>(value)); };
        const InsideSpan<VD> span = order_depths_from(
            record_.fronts & 7u, set(fragments_.near_depth - record_.center_depth),
            plane(dd, 0, x, y), plane(dd, 1, x, y), plane(dd, 2, x, y), plane(dd, 3, x, y));
        const auto exact = [&](std::size_t i, float rounded) {
            return hn::Set(dd, static_cast<double>(rounded) + static_cast<double>(record_.low[i]));
        };
        const VD origin = exact(0, record_.scalar), per_z = exact(1, record_.scalar_per_z);
        const VD aside = hn::Add(hn::Mul(exact(2, record_.scalar_per_column), x),
                                 hn::Mul(exact(3, record_.scalar_per_row), y));
        const VD one = hn::Set(dd, 1.0), center = set(record_.center_depth);
        const auto z_of = [&](VD depth) HWY_ATTR {
            const VD most = hn::Set(dd, -1e-30);
            return hn::Div(hn::Set(dd, -1.0), hn::Min(hn::Add(center, depth), most));
        };
        const VD z_front = perspective ? z_of(span.enter) : one,
                 z_back = perspective ? z_of(span.leave) : one;
        const VD z_center = perspective ? z_of(hn::Zero(dd)) : one;
        const auto scalar = [&](VD depth, VD z) HWY_ATTR {
            const VD from_center = hn::Mul(hn::Mul(depth, z), z_center);
            return hn::Add(hn::Add(origin, hn::Mul(from_center, per_z)), hn::Mul(z, aside));
        };
        const VD length = hn::Mul(hn::Mul(hn::Sub(span.leave, span.enter), z_front), z_back);
        return {length, scalar(span.enter, z_front), scalar(span.leave, z_back)};
    }

  private:
    // The depth of a face, from the record's center.
    template <class DD, class VD>
    HWY_INLINE VD plane(DD dd, std::size_t face, VD x, VD y) const {
        const auto sum = [&](const TetRecord::Pairs& pairs) {
            return hn::Set(
                dd, static_cast<double>(pairs.high[face]) + static_cast<double>(pairs.low[face]));
        };
        return hn::Add(hn::Add(sum(record_.depth), hn::Mul(sum(record_.depth_per_column), x)),
                       hn::Mul(sum(record_.depth_per_row), y));
    }

    template <class DD, class VD>
    HWY_INLINE VD move(DD dd, VD place, float center, float middle, double shift) const {
        const auto from_middle =
            hn::Add(place, hn::Set(dd, static_cast<double>(center) - static_cast<double>(middle)));
        const double per_pixel =
            fragments_.ray_perturbation.z * static_cast<double>(fragments_.pixel_size);
        return hn::Sub(hn::Add(place, hn::Set(dd, shift)),
                       hn::Mul(from_middle, hn::Set(dd, per_pixel)));
    }

    const TetFragments& fragments_;
    const TetRecord& record_;
};

// Which of the two planes of a cell fragment, on which the scalar is its least or its largest, rays
// may meet within the tet.
class PartCuts {
  public:
    // Neither where `cut` is false.
    PartCuts(bool cut, const TetRecord& record)
        : lower_(cut && record.has_lower_cut()),
          upper_(cut && record.has_upper_cut()),
          lower_is_front_((record.fronts & TetRecord::lower_cut_is_front) != 0),
          upper_is_front_((record.fronts & TetRecord::upper_cut_is_front) != 0) {}

    // Shortens a ray's run to the stretch between the two planes.
    template <class D>
    HWY_INLINE void shorten(D d, const TetRecord& record, hn::Vec<D> column, hn::Vec<D> row,
                            InsideSpan<hn::Vec<D>>& span) const {
        const auto cut = [&](bool front, float at_center, float per_column,
                             float per_row) HWY_ATTR {
            const auto depth = at_row(d, at_column(d, at_center, per_column, column), per_row, row);
            if (front) {
                span.enter = hn::Max(span.enter, depth);
            } else {
                span.leave = hn::Min(span.leave, depth);
            }
        };
        if (lower_)
            cut(lower_is_front_, record.lower_cut[0], record.lower_cut[1], record.lower_cut[2]);
        if (upper_) cut(upper_is_front_, record.upper_cut, record.limits[0], record.limits[1]);
    }

  private:
    bool lower_, upper_, lower_is_front_, upper_is_front_;
};

// Where a ray enters or leaves: its z (1 in orthographic views), and how far along z that is behind
// the record's center.
template <class V>
struct TetSpanEnd {
    V z, from_center;
};
template <class V>
struct TetSpan {
    TetSpanEnd<V> front, back;
    V world_length;
};

// `slant`: world length per unit of z. Rays that miss the cell fragment get a span of 0. `Shader`:
// see projection/tet_drawing-inl.h.
template <class D, class Shader>
HWY_INLINE TetSpan<hn::Vec<D>> find_ends(D d, const Shader& shader, const TetFragments& fragments,
                                         const TetRecord& record,
                                         const InsideSpan<hn::Vec<D>>& span, hn::Vec<D> slant) {
    using V = hn::Vec<D>;
    V length = hn::Sub(span.leave, span.enter);
    V z_front = hn::Set(d, 1.0f), z_back = z_front, front = span.enter, back = span.leave;
    if (shader.perspective) {
        // Differences of z are computed from differences of depth, so that a distant eye costs no
        // digits.
        const V center = hn::Set(d, record.center_depth);
        const V depth_front = hn::Add(center, span.enter), depth_back = hn::Add(center, span.leave);
        if (fragments.one_division) {
            // All depths in front of the eye are negative; near the horizon rounding may give 0.
            const V most = hn::Set(d, -1e-18f);
            const V near = hn::Min(depth_front, most), far = hn::Min(depth_back, most);
            const V product = hn::Div(hn::Set(d, -1.0f), hn::Mul(near, far));
            z_front = hn::Mul(far, product);
            z_back = hn::Mul(near, product);
        } else {
            const V minus_one = hn::Set(d, -1.0f), most = hn::Set(d, -1e-30f);
            z_front = hn::Div(minus_one, hn::Min(depth_front, most));
            z_back = hn::Div(minus_one, hn::Min(depth_back, most));
        }
        length = hn::Mul(hn::Mul(hn::Mul(length, z_front), z_back), slant);
        const V z_center = hn::Set(d, record.center_z);
        front = hn::Mul(hn::Mul(front, z_front), z_center);
        back = hn::Mul(hn::Mul(back, z_back), z_center);
    }
    if (shader.opacity_only) length = hn::Mul(length, hn::Set(d, fragments.depth_scale));
    return {{z_front, front}, {z_back, back}, length};
}

// `aside`: the scalar's change from the record's center, at z = 1.
template <class D, class Shader>
HWY_INLINE TetRun<hn::Vec<D>> run_between(D d, const Shader& shader, const TetRecord& record,
                                          const TetSpan<hn::Vec<D>>& ends, hn::Vec<D> aside) {
    using V = hn::Vec<D>;
    TetRun<V> run{hn::Zero(d), hn::Zero(d), ends.world_length};
    if (!shader.scalars) return run;
    const V least = hn::Set(d, shader.cut ? 0.0f : record.limits[0]),
            largest = hn::Set(d, shader.cut ? 1.0f : record.limits[1]);
    const V origin = hn::Set(d, record.scalar), per_z = hn::Set(d, record.scalar_per_z);
    const auto scalar = [&](const TetSpanEnd<V>& end) HWY_ATTR {
        const V sum =
            hn::Add(hn::Add(origin, hn::Mul(end.from_center, per_z)), hn::Mul(end.z, aside));
        return hn::Min(hn::Max(sum, least), largest);
    };
    run.front = scalar(ends.front);
    run.back = scalar(ends.back);
    return run;
}

template <class D, class Shader>
HWY_INLINE TetRun<hn::Vec<D>> find_run(D d, const Shader& shader, const TetFragments& fragments,
                                       const TetRecord& record, const InsideSpan<hn::Vec<D>>& span,
                                       hn::Vec<D> aside, hn::Vec<D> slant) {
    return run_between(d, shader, record, find_ends(d, shader, fragments, record, span, slant),
                       aside);
}

// Tells whether lengths and scalars of the tet's runs are computed in double precision: of careful
// tets that are not cut into parts.
HWY_INLINE bool has_exact_runs(const TetFragments& fragments, const PartArea& area) {
    return area.careful && fragments.source != SegmentSource::parts;
}

// The run of a ray through a careful tet. In float32 a short run through a long tet would be a
// small difference of large numbers, and so would be a scalar within the window of a tet that runs
// far outside it (facts/far_scalars.h). `slanted`: lengths along rays are longer than differences
// of z.
template <class D, class Shader>
HWY_INLINE TetRun<hn::Vec<D>> find_exact_run(D d, const Shader& shader,
                                             const TetFragments& fragments, const TetRecord& record,
                                             const InsideSpan<hn::Vec<D>>& span, hn::Vec<D> column,
                                             hn::Vec<D> row, bool slanted) {
    using V = hn::Vec<D>;
    const CarefulDepths<D> depths(d, fragments, record);
    const Doubles<D> columns = to_doubles(d, column), rows = to_doubles(d, row);
    const auto low = depths.exact_at(shader.perspective, columns.low, rows.low),
               high = depths.exact_at(shader.perspective, columns.high, rows.high);
    V length = to_floats(d, Doubles<D>{low.length, high.length});
    if (slanted) {
        const V pixel = hn::Set(d, fragments.pixel_size);
        const auto from_middle = [&](V place, float center, float middle) HWY_ATTR {
            return hn::Mul(hn::Add(place, hn::Set(d, center - middle)), pixel);
        };
        const V x = from_middle(column, record.center[0], fragments.image_middle.x),
                y = from_middle(row, record.center[1], fragments.image_middle.y);
        const V square = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
        length = hn::Mul(length, hn::Sqrt(hn::Add(hn::Set(d, 1.0f), square)));
    }
    if (shader.opacity_only) length = hn::Mul(length, hn::Set(d, fragments.depth_scale));
    const V least = hn::Set(d, record.limits[0]), largest = hn::Set(d, record.limits[1]);
    const auto scalar = [&](const auto& of_low, const auto& of_high) HWY_ATTR {
        const V found = to_floats(d, Doubles<D>{of_low, of_high});
        return hn::Min(hn::Max(found, least), largest);
    };
    const auto met = hn::Gt(span.leave, span.enter);
    return {scalar(low.front, high.front), scalar(low.back, high.back),
            hn::IfThenElseZero(met, length)};
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
