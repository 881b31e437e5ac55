// SPDX-License-Identifier: Apache-2.0
// Finds the segments of the rays of some pixels inside a cell fragment. This is the vector form of
// shaders/projection/silhouette.glsl, whose comments give the reasons.
#if defined(LAMINA_PROJECTION_FRAGMENT_SEGMENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_FRAGMENT_SEGMENT_INL_H_
#undef LAMINA_PROJECTION_FRAGMENT_SEGMENT_INL_H_
#else
#define LAMINA_PROJECTION_FRAGMENT_SEGMENT_INL_H_
#endif

#include "optics/segment_integral.h"
#include "projection/cpu_fragments.h"
#include "simd/vectors-inl.h"
#include "tiles/segment_optics-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// The depths at which a ray enters and leaves a cell fragment, relative to the record's center.
template <class V>
struct InsideSpan {
    V enter, leave;
};

// A ray inside a cell fragment, with values that segments in float32 need: `aside`, the scalar's
// change from the record's center to the ray at z = 1; `slant`, world length per unit of z.
struct SlantedRay {
    InsideSpan<Float> span;
    Float aside, slant;
};
// A ray inside a cell fragment and its pixel relative to the center, for lit or exact segments.
struct PlacedRay {
    InsideSpan<Float> span;
    Float column, row;
};

// The segment of a ray through a cell fragment. Scalars are normalised as the record says. A ray
// that misses the cell fragment has equal scalars and length 0.
struct FragmentSegment {
    Float front, back, world_length;
};

// These two compute a linear function of the pixel at a column and then at a row, both relative to
// the record's center. They round as shaders/projection/silhouette.glsl does.
LAMINA_INLINE Float at_column(float at_center, float per_column, Float column) {
    return at_center + per_column * column;
}
LAMINA_INLINE Float at_row(Float value, float per_row, Float row) {
    return value + per_row * row;
}

// Returns the depths at which the ray enters and leaves: the largest depth on front faces, which
// come first, and the least depth on the other faces.
template <class V>
LAMINA_INLINE InsideSpan<V> order_depths(std::uint32_t fronts, V d0, V d1, V d2, V d3) {
    switch (fronts) {
        case 1:
            return {d0, min(min(d1, d2), d3)};
        case 2:
            return {max(d0, d1), min(d2, d3)};
        default:
            return {max(max(d0, d1), d2), d3};
    }
}

// Returns the same depths for 0 to 3 front faces. No ray enters before `nearest`, the near plane.
template <class V>
LAMINA_INLINE InsideSpan<V> order_depths_from(std::uint32_t fronts, V nearest, V d0, V d1, V d2,
                                              V d3) {
    if (fronts == 0) return {nearest, min(min(d0, d1), min(d2, d3))};
    const InsideSpan<V> span = order_depths(fronts, d0, d1, d2, d3);
    return {max(nearest, span.enter), span.leave};
}

// Finds the depths on faces in float32.
class PlainDepths {
  public:
    LAMINA_INLINE PlainDepths(const TetFragments&, const SilhouetteRecord& record)
        : seen_(record.seen()), fronts_(record.front_faces()) {}

    struct AtColumns {
        Float d0, d1, d2, d3;
    };
    LAMINA_INLINE AtColumns at_columns(Float column) const {
        const auto start = [&](std::size_t face) LAMINA_LAMBDA {
            return at_column(seen_.depth.high[face], seen_.depth_per_column.high[face], column);
        };
        return {start(0), start(1), start(2), start(3)};
    }
    LAMINA_INLINE InsideSpan<Float> at(const AtColumns& start, Float row) const {
        const auto& per_row = seen_.depth_per_row.high;
        return order_depths(fronts_, at_row(start.d0, per_row[0], row),
                            at_row(start.d1, per_row[1], row), at_row(start.d2, per_row[2], row),
                            at_row(start.d3, per_row[3], row));
    }

  private:
    const SeenTet& seen_;
    std::uint32_t fronts_;
};

// Finds the depths on faces in double precision, for FragmentKind::careful.
class CarefulDepths {
  public:
    // Sums are computed here and not for each vector of pixels, because the compiler cannot exclude
    // that writing to the queue changes the record.
    LAMINA_INLINE CarefulDepths(const TetFragments& fragments, const SilhouetteRecord& record)
        : record_(record),
          fronts_(record.front_faces()),
          nearest_(fragments.near_depth - record.seen().center_depth),
          middle_{double{record.seen().center[0]} - double{fragments.image_middle.x},
                  double{record.seen().center[1]} - double{fragments.image_middle.y}},
          shift_(fragments.ray_perturbation),
          shift_per_pixel_(fragments.ray_perturbation.z * double{fragments.pixel_size}) {
        const SeenTet& seen = record.seen();
        const auto sum = [](const SeenTet::Pairs& pairs, std::size_t face) {
            return double{pairs.high[face]} + double{pairs.low[face]};
        };
        for (std::size_t face = 0; face < 4; ++face) {
            depth_[face] = sum(seen.depth, face);
            per_column_[face] = sum(seen.depth_per_column, face);
            per_row_[face] = sum(seen.depth_per_row, face);
        }
    }

    struct AtColumns {
        Float64 d0, d1, d2, d3;
    };
    LAMINA_INLINE AtColumns at_columns(Float column) const {
        const Float64 x = moved_column(Float64(column));
        const auto start = [&](std::size_t face)
                               LAMINA_LAMBDA { return depth_[face] + per_column_[face] * x; };
        return {start(0), start(1), start(2), start(3)};
    }
    LAMINA_INLINE InsideSpan<Float> at(const AtColumns& start, Float row) const {
        const Float64 y = moved_row(Float64(row));
        const auto depth = [&](std::size_t face, const Float64& at_column)
                               LAMINA_LAMBDA { return to_float(at_column + per_row_[face] * y); };
        return order_depths_from(fronts_, Float(nearest_), depth(0, start.d0), depth(1, start.d1),
                                 depth(2, start.d2), depth(3, start.d3));
    }

    // A ray's segment: its length along z, and the scalars at its ends, not clamped.
    struct ExactSpan {
        Float64 length;  // along z
        Float64 front, back;
    };
    // `column`, `row`: from the record's center.
    LAMINA_INLINE ExactSpan exact_at(bool perspective, Float column, Float row) const {
        const Float64 x = moved_column(Float64(column)), y = moved_row(Float64(row));
        const auto plane = [&](std::size_t face) LAMINA_LAMBDA {
            return depth_[face] + per_column_[face] * x + per_row_[face] * y;
        };
        const SeenTet& seen = record_.seen();
        const InsideSpan<Float64> span = order_depths_from(fronts_, Float64(double{nearest_}),
                                                           plane(0), plane(1), plane(2), plane(3));
        const auto exact = [&](std::size_t i, float rounded) {
            return double{rounded} + double{record_.tet.scalar_rest[i]};
        };
        const double origin = exact(0, seen.scalar), per_z = exact(1, seen.scalar_per_z);
        const Float64 aside =
            exact(2, seen.scalar_per_column) * x + exact(3, seen.scalar_per_row) * y;
        const auto z_of = [&](Float64 depth) LAMINA_LAMBDA {
            if (!perspective) return Float64(1);
            return -1 / min(double{seen.center_depth} + depth, -1e-30);
        };
        const Float64 z_front = z_of(span.enter), z_back = z_of(span.leave), z_center = z_of(0);
        const auto scalar = [&](Float64 depth, Float64 z) LAMINA_LAMBDA {
            return origin + depth * z * z_center * per_z + z * aside;
        };
        const Float64 length = (span.leave - span.enter) * z_front * z_back;
        return {length, scalar(span.enter, z_front), scalar(span.leave, z_back)};
    }

  private:
    // These move a pixel's place by the ray perturbation, less its component along the ray.
    LAMINA_INLINE Float64 moved_column(Float64 column) const {
        return moved(column, middle_.x, shift_.x);
    }
    LAMINA_INLINE Float64 moved_row(Float64 row) const { return moved(row, middle_.y, shift_.y); }
    LAMINA_INLINE Float64 moved(Float64 place, double from_middle, double shift) const {
        return place + shift - (place + from_middle) * shift_per_pixel_;
    }

    const SilhouetteRecord& record_;
    std::uint32_t fronts_;
    float nearest_;      // depth of the near plane, from the record's center
    glm::dvec2 middle_;  // the center, from the picture's middle
    glm::dvec3 shift_;   // the ray perturbation
    double shift_per_pixel_;
    double depth_[4], per_column_[4], per_row_[4];  // planes of the faces
};

// The planes that cut a cell fragment, on which the scalar is its least or its largest. Planes in
// front of everything (FragmentRecord) cut nothing and are left out.
class FragmentCuts {
  public:
    // `cut`: false if the record is that of a whole tet, without cuts.
    FragmentCuts(bool cut, const FragmentRecord& record)
        : lower_(cut && record.has_lower_cut()),
          upper_(cut && record.has_upper_cut()),
          lower_is_front_((record.fronts & FragmentRecord::lower_cut_is_front) != 0),
          upper_is_front_((record.fronts & FragmentRecord::upper_cut_is_front) != 0) {}

    // Shortens a ray's segment to the piece between the two planes.
    LAMINA_INLINE void shorten(const FragmentRecord& record, Float column, Float row,
                               InsideSpan<Float>& span) const {
        const auto cut = [&](bool front, float at_center, float per_column,
                             float per_row) LAMINA_LAMBDA {
            const Float depth = at_row(at_column(at_center, per_column, column), per_row, row);
            if (front) {
                span.enter = max(span.enter, depth);
            } else {
                span.leave = min(span.leave, depth);
            }
        };
        if (lower_)
            cut(lower_is_front_, record.lower_cut[0], record.lower_cut[1], record.lower_cut[2]);
        if (upper_)
            cut(upper_is_front_, record.upper_cut, record.upper_cut_per_column,
                record.upper_cut_per_row);
    }

  private:
    bool lower_, upper_, lower_is_front_, upper_is_front_;
};

// The point where a ray enters or leaves: its z (1 if orthographic), and z minus the center's.
struct TetSpanEnd {
    Float z, from_center;
};
// A ray's segment in a cell fragment, without scalars.
struct TetSpan {
    TetSpanEnd front, back;
    Float world_length;
};

// Returns the ends and the length of segments. `slant`: world length per unit of z. Rays that miss
// the cell fragment come with a span of 0. `Shader`: see projection/tet_drawing-inl.h.
template <class Shader>
LAMINA_INLINE TetSpan find_ends(const Shader& shader, const TetFragments& fragments,
                                const SilhouetteRecord& record, const InsideSpan<Float>& span,
                                Float slant) {
    const SeenTet& seen = record.seen();
    Float length = span.leave - span.enter;
    Float z_front(1), z_back(1), front = span.enter, back = span.leave;
    if (shader.perspective) {
        // Differences of z come from differences of depth, so that a distant eye costs no digits.
        const Float depth_front = seen.center_depth + span.enter;
        const Float depth_back = seen.center_depth + span.leave;
        if (fragments.shares_division) {
            // All depths in front of the eye are negative; near the horizon rounding may give 0.
            const Float near = min(depth_front, -1e-18f), far = min(depth_back, -1e-18f);
            const Float product = -1 / (near * far);
            z_front = far * product;
            z_back = near * product;
        } else {
            z_front = -1 / min(depth_front, -1e-30f);
            z_back = -1 / min(depth_back, -1e-30f);
        }
        length = length * z_front * z_back * slant;
        front = front * z_front * seen.center_z;
        back = back * z_back * seen.center_z;
    }
    if (shader.opacity_only) length *= fragments.depth_scale;
    return {{z_front, front}, {z_back, back}, length};
}

// Returns the segments with the scalars at their ends. `aside`: as in SlantedRay.
template <class Shader>
LAMINA_INLINE FragmentSegment segment_between(const Shader& shader, const SilhouetteRecord& record,
                                              const TetSpan& ends, Float aside) {
    FragmentSegment segment{0, 0, ends.world_length};
    if (!shader.scalars) return segment;
    const float least = shader.cut ? 0.0f : record.tet.least;
    const float largest = shader.cut ? 1.0f : record.tet.largest;
    const SeenTet& seen = record.seen();
    const auto scalar = [&](const TetSpanEnd& end) LAMINA_LAMBDA {
        const Float sum = seen.scalar + end.from_center * seen.scalar_per_z + end.z * aside;
        return clamp(sum, least, largest);
    };
    segment.front = scalar(ends.front);
    segment.back = scalar(ends.back);
    return segment;
}

// Tells whether segments of a tet are computed in double precision: if it is careful and not cut.
LAMINA_INLINE bool has_exact_segments(const TetFragments& fragments, const CoveredArea& area) {
    return area.careful && fragments.source != SegmentSource::parts;
}

// Returns the segment of a ray through a careful tet, computed in double precision. In float32 a
// short segment through a long tet would be a small difference of large numbers, and so would be a
// scalar within the window in a tet whose scalars reach far outside it (facts/drawn_range.h).
// `slanted`: lengths along rays are longer than differences of z.
template <class Shader>
LAMINA_INLINE FragmentSegment find_exact_segment(const Shader& shader,
                                                 const TetFragments& fragments,
                                                 const SilhouetteRecord& record,
                                                 const PlacedRay& ray, bool slanted) {
    const auto [exact_length, front, back] =
        CarefulDepths(fragments, record).exact_at(shader.perspective, ray.column, ray.row);
    Float length = to_float(exact_length);
    if (slanted) {
        const auto from_middle = [&](Float place, float center, float middle) LAMINA_LAMBDA {
            return (place + (center - middle)) * fragments.pixel_size;
        };
        const Float x = from_middle(ray.column, record.seen().center[0], fragments.image_middle.x);
        const Float y = from_middle(ray.row, record.seen().center[1], fragments.image_middle.y);
        length *= sqrt(1 + (x * x + y * y));
    }
    if (shader.opacity_only) length *= fragments.depth_scale;
    const auto within = [&](Float64 scalar) LAMINA_LAMBDA {
        return clamp(to_float(scalar), record.tet.least, record.tet.largest);
    };
    return {within(front), within(back), zero_unless(ray.span.leave > ray.span.enter, length)};
}

LAMINA_INLINE Fragment with_color(const glm::vec3& color, Float opacity) {
    return {color.r * opacity, color.g * opacity, color.b * opacity, opacity};
}

LAMINA_INLINE Fragment constant_color(const TetFragments& fragments,
                                      const FragmentSegment& segment) {
    const glm::vec4& optics = fragments.constant_optics;
    return with_color(glm::vec3(optics), opacity_from_depth(optics.a * segment.world_length));
}

// Returns the colour of segments through a cell fragment, with linear optics; if not `colored`, it
// is fragments.single_color. `most_depth`: a bound on the segments' optical depth.
LAMINA_INLINE Fragment cell_fragment_color(bool colored, DepthBound most_depth,
                                           const TetFragments& fragments,
                                           const FragmentRecord& record,
                                           const FragmentSegment& segment) {
    const auto optics = [&](std::size_t i, Float place) LAMINA_LAMBDA {
        return mix(Float(record.low[i]), Float(record.high[i]), place);
    };
    const Float front = optics(3, segment.front), back = optics(3, segment.back);
    if (!colored) {
        const Float mean = 0.5f * front + 0.5f * back;
        return with_color(fragments.single_color, opacity_from_depth(mean * segment.world_length));
    }
    const Float p = front * segment.world_length, q = back * segment.world_length;
    const Float depth = 0.5f * p + 0.5f * q;
    Float opacity, most;
    if (most_depth == DepthBound::faint) {
        opacity = faint_opacity(depth);
        most = faint_front_weight(p, q);
    } else {
        opacity = opacity_from_depth(depth);
        most = most_depth == DepthBound::thin
                   ? thin_front_weight(p, q)
                   : front_weight(fragments.front_weights, FrontWeightTable::nodes, p, q);
    }
    const Float weight = min(most, opacity);
    // This is opacity * back + weight * (front - back), written so that no term is negative.
    const Float of_high = (opacity - weight) * segment.back + weight * segment.front;
    const Float of_low = opacity - of_high;
    const auto channel = [&](std::size_t i) LAMINA_LAMBDA {
        return of_low * record.low[i] + of_high * record.high[i];
    };
    return {channel(0), channel(1), channel(2), opacity};
}

LAMINA_SIMD_END

#endif
