// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace lamina {

// One tet of one view, or a part of it, as shaders/projection/silhouette.vert reads it, 12 uvec4.
//
// `Depth` is z in orthographic views and -1/z in perspective ones: it grows with eye-space depth z
// and is linear in window coordinates on every plane (Kraus 2004, section 2.1). A ray is inside the
// tet from the largest depth on faces that the eye is in front of to the least on all others.
struct alignas(16) TetRecord {
    // A double as the sum of two floats, for the four faces.
    struct Pairs {
        std::array<float, 4> high, low;
    };
    // On the plane of each face, the front faces first: depth at `center` less `center_depth`, and
    // its change per pixel to the right and upwards.
    Pairs depth, depth_per_column, depth_per_row;
    std::array<float, 2> center;  // a pixel centre near the tet, window coordinates
    float center_depth;           // somewhere in the tet
    float center_z;               // the same as z
    // The scalar at that point, of a range that becomes [0, 1]: the projector's, or the part's. Its
    // change along the ray there per unit of z, and per pixel at z = 1 (perspective), or per pixel.
    float scalar, scalar_per_z, scalar_per_column, scalar_per_row;
    // Of a whole tet the least and the largest scalar of its corners; of a part `upper_cut` per
    // column and per row.
    std::array<float, 2> limits;
    // Front faces, 0 (the eye is inside) to 3; of a part also whether its lower cut (bit 3)
    // and its upper one (bit 4) are fronts.
    std::uint32_t fronts;
    std::uint32_t number;  // of the tet or part, for dithering

    // Of a part: on the planes on which the scalar is its least and its largest what `depth` has on
    // faces. Where the tet itself goes no farther, a front in front of everything.
    std::array<float, 3> lower_cut;  // depth, per column, per row
    float upper_cut;                 // depth
    std::array<float, 4> low, high;  // colour and extinction at these scalars

    bool has_lower_cut() const { return cuts(lower_cut_is_front, lower_cut); }
    bool has_upper_cut() const {
        return cuts(upper_cut_is_front, {upper_cut, limits[0], limits[1]});
    }

    static constexpr std::uint32_t lower_cut_is_front = 8, upper_cut_is_front = 16;  // of `fronts`
    static constexpr float in_front_of_all = -1e30f;

  private:
    bool cuts(std::uint32_t front, const std::array<float, 3>& plane) const {
        return (fronts & front) == 0 || plane != std::array{in_front_of_all, 0.0f, 0.0f};
    }
};
static_assert(sizeof(TetRecord) == 192);

// Depths on faces in float32 are good enough where their rounding is at most this share of the
// tet's depth: a face that is seen so nearly edge-on that it exceeds this is met by the rays of
// hardly a pixel, unless whole walls of a mesh are.
inline constexpr double float_tolerance = 2e-3;

// Deeper than everything, and finite also after a product with any window coordinate.
inline constexpr double beyond_all = -double{TetRecord::in_front_of_all};

}  // namespace lamina
