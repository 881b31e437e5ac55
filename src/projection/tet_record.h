// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// One tet or cell fragment of one view, as shaders/projection/silhouette.vert reads it: 12 uvec4.
//
// `Depth` is z in orthographic views and -1/z in perspective ones. It grows with eye-space depth z
// and is linear in window coordinates on every plane (Kraus 2004, section 2.1). A ray is inside the
// tet from the largest depth on front faces, which the eye is in front of, to the least depth on
// the other faces.
struct alignas(16) TetRecord {
    // For each of the four faces a double as the sum of two floats.
    struct Pairs {
        std::array<float, 4> high, low;
    };
    // The plane of each face, front faces first: its depth at `center` minus `center_depth`, and
    // the change of depth per pixel to the right and upwards.
    Pairs depth, depth_per_column, depth_per_row;
    std::array<float, 2> center;  // a pixel centre near the tet, in window coordinates
    float center_depth;           // depth of a point in the tet
    float center_z;               // z of that point
    // The scalar at that point, normalised so that a range becomes [0, 1]: the projector's range,
    // or that of the cell fragment. Then its change along the ray per unit of z, and its change per
    // pixel (in perspective views, per pixel at z = 1).
    float scalar, scalar_per_z, scalar_per_column, scalar_per_row;
    // Whole tet: the least and the largest scalar of its corners. Cell fragment: the change of
    // `upper_cut` per column and per row.
    std::array<float, 2> limits;
    // The number of front faces, 0 (the eye is inside) to 3. For a cell fragment bit 3 says that
    // its lower cut is a front, and bit 4 that its upper cut is one.
    std::uint32_t fronts;
    std::uint32_t number;  // of the tet or cell fragment, for dithering

    // For a cell fragment: the planes on which the scalar is its least and its largest, in the form
    // that `depth` has for faces. Where the tet itself has no smaller (larger) scalars, the plane
    // is a front in front of everything.
    std::array<float, 3> lower_cut;  // depth, per column, per row
    float upper_cut;                 // depth
    // Colour and extinction at these scalars. Whole tet: `low` is what `scalar` and the three
    // numbers behind it lack of double precision; only TetProjector sets it.
    std::array<float, 4> low, high;

    bool has_lower_cut() const { return cuts(lower_cut_is_front, lower_cut); }
    bool has_upper_cut() const {
        return cuts(upper_cut_is_front, {upper_cut, limits[0], limits[1]});
    }

    // Bits of `fronts`.
    static constexpr std::uint32_t lower_cut_is_front = 8, upper_cut_is_front = 16;
    static constexpr float in_front_of_all = -1e30f;

  private:
    bool cuts(std::uint32_t front, const std::array<float, 3>& plane) const {
        return (fronts & front) == 0 || plane != std::array{in_front_of_all, 0.0f, 0.0f};
    }
};
static_assert(sizeof(TetRecord) == 192);

// Depths on faces in float32 are good enough where their rounding error is at most this share of
// the tet's thickness in depth. A face exceeds this where it is seen nearly edge-on. Few pixels
// have rays that meet such a face, unless a mesh has whole walls of them.
inline constexpr double float_tolerance = 2e-3;

// Deeper than everything. The product with any window coordinate is still finite.
inline constexpr double beyond_all = -double{TetRecord::in_front_of_all};

}  // namespace lamina
