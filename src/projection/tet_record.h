// SPDX-License-Identifier: Apache-2.0
// Records of tets as one view sees them, from which fragments find their rays' segments: one for
// each whole tet or, if tets are cut, for each cell fragment. `Depth` is z in orthographic views
// and -1/z in perspective ones. It grows with eye-space depth z and is linear in window coordinates
// on every plane (Kraus 2004, section 2.1). Front faces are those that the eye is in front of. A
// ray is inside the tet from the largest depth on front faces to the least depth on the others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "scene/camera.h"
#include "tiles/tile_image.h"

namespace lamina {

// A cell fragment: the region of a tet on which the transfer function is linear, or the whole tet.
struct CellFragment {
    static constexpr std::int32_t whole = -1;

    std::int32_t tet;
    std::int32_t piece = whole;  // index into TetPieces::pieces()
};

// Returns a number of its own for each cell fragment of a mesh of `tets` tets, for dithering.
inline std::uint32_t cell_fragment_number(const CellFragment& cell_fragment, std::size_t tets) {
    return static_cast<std::uint32_t>(cell_fragment.tet) +
           static_cast<std::uint32_t>(cell_fragment.piece + 1) * static_cast<std::uint32_t>(tets);
}

// How a CellFragment's fragments are computed. Later kinds are slower, but right for earlier ones.
enum class FragmentKind {
    thin,    // optical depth at most thin_depth (optics/segment_integral.h); depths on faces in
             // float32
    plain,   // depths on faces in float32
    careful  // depths on faces in double precision: for faces that are seen nearly edge-on, for
             // cell fragments that the near plane cuts, and if the eye is inside
};
inline constexpr std::size_t fragment_kinds = 3;  // number of FragmentKinds

// The faces and the scalar of a tet, with which both records begin.
struct alignas(16) SeenTet {
    // A double as the sum of two floats for each of the four faces.
    struct Pairs {
        std::array<float, 4> high, low;
    };
    // The plane of each face, front faces first: its depth at `center` minus `center_depth`, and
    // the change of depth per pixel to the right and upwards.
    Pairs depth, depth_per_column, depth_per_row;
    std::array<float, 2> center;  // a pixel centre near the tet, in window coordinates
    float center_depth;           // depth of a point in the tet
    float center_z;               // z of that point
    // The scalar at that point, normalised so that [0, 1] is TetsInView::range for a whole tet, and
    // the cell fragment's own range for a cell fragment. Then its change along the ray per unit of
    // z, and its change per pixel (in perspective views, per pixel at z = 1).
    float scalar, scalar_per_z, scalar_per_column, scalar_per_row;
};

// A whole tet.
struct TetRecord {
    SeenTet seen;
    float least, largest;  // scalars of its corners, normalised
    std::uint32_t fronts;  // the number of front faces, 0 (the eye is inside) to 3
    std::uint32_t number;  // cell_fragment_number(), for dithering
    std::array<float, 4> unused;
    // Remainders of `scalar` and the next three members in float. Only careful tets have them.
    std::array<float, 4> scalar_rest;
    std::array<float, 4> also_unused;
};

// A cell fragment: the region of a tet in one interval of the transfer function. Two planes bound
// it, the cuts at its least and largest scalar, in the form of SeenTet::depth. If the tet has no
// smaller (larger) scalars, the lower (upper) cut is a front plane in front of everything.
struct FragmentRecord {
    SeenTet seen;
    float upper_cut_per_column, upper_cut_per_row;
    std::uint32_t fronts;            // as in TetRecord, and bits for cuts that are fronts
    std::uint32_t number;            // cell_fragment_number(), for dithering
    std::array<float, 3> lower_cut;  // depth, per column, per row
    float upper_cut;                 // depth
    std::array<float, 4> low, high;  // colour and extinction at these scalars

    bool has_lower_cut() const { return cuts(lower_cut_is_front, lower_cut); }
    bool has_upper_cut() const {
        return cuts(upper_cut_is_front, {upper_cut, upper_cut_per_column, upper_cut_per_row});
    }

    // Bits of `fronts`.
    static constexpr std::uint32_t lower_cut_is_front = 8, upper_cut_is_front = 16;
    static constexpr float in_front_of_all = -1e30f;

  private:
    bool cuts(std::uint32_t front, const std::array<float, 3>& plane) const {
        return (fronts & front) == 0 || plane != std::array{in_front_of_all, 0.0f, 0.0f};
    }
};

// Either record, in the layout of shaders/projection/silhouette.vert: 12 uvec4. A plan draws only
// whole tets or only cell fragments; the common first members are read through either.
union SilhouetteRecord {
    TetRecord tet;
    FragmentRecord fragment;

    const SeenTet& seen() const { return tet.seen; }
    SeenTet& seen() { return tet.seen; }
    std::uint32_t front_faces() const { return tet.fronts & 7u; }
    std::uint32_t number() const { return tet.number; }
};
static_assert(sizeof(TetRecord) == 192 && sizeof(FragmentRecord) == 192);
static_assert(sizeof(SilhouetteRecord) == 192);

// The gradient in a tet of one view, linear in space, for a lit cell fragment, in the layout of
// shaders/projection/silhouette.vert: 3 uvec4. It is in the axes of the world and in the unit of
// StoredGradients (projection/tet_projector.h), in which no component exceeds 1.
struct alignas(16) GradientRecord {
    // One component: at the point of SeenTet::center, its change along the ray per unit of z, and
    // its change per pixel to the right and upwards (in perspective views, per pixel at z = 1).
    struct Component {
        float at_center, per_z, per_column, per_row;
    };
    std::array<Component, 3> components;
};
static_assert(sizeof(GradientRecord) == 48);

// Largest rounding error, as a share of the tet's thickness in depth, at which depths on faces in
// float32 are good enough. A face exceeds it if it is seen nearly edge-on. Few pixels have rays
// that meet such a face, unless a mesh has large walls of them.
inline constexpr double float_tolerance = 2e-3;

// A depth beyond everything. Its product with any window coordinate is still finite.
inline constexpr double beyond_all = -double{FragmentRecord::in_front_of_all};

// The blocks of pixels, all of one size, that a tet may cover. Rays meet the tet if
// the depths on all its front faces are less than those on all its back faces: inside three or four
// lines, the silhouette, on which a front and a back depth are equal. Each line bounds the column
// of a block's first pixel, relative to the area's first column: by `at_first` for blocks that
// begin in the area's first row, and by `per_row` more for each row below.
struct TetOutline {
    static constexpr float none = std::numeric_limits<float>::infinity();

    std::array<float, 4> at_first{none, none, none, none}, per_row{};
    // A bit for each bound that is a least column; the other bounds are greatest columns.
    std::uint8_t least = 0;
};

// A bound on the optical depth of any segment through a cell fragment, on which the cost of its
// colour depends. thin: at most thin_depth; faint: at most faint_depth (optics/segment_integral.h).
enum class DepthBound : std::uint8_t { any, thin, faint };

// The pixels that a cell fragment may cover: columns from the left, rows from the picture's top.
struct alignas(64) CoveredArea : PixelArea {
    bool careful;      // depths on its faces are found in double precision (FragmentKind::careful)
    DepthBound depth;  // bound for any segment through it
    // If true, pixels outside these columns and rows are not drawn, and no segment ends beyond
    // `farthest`, a depth relative to the record's center. Outside a tet the planes of its faces
    // meet at any depth, where rounding alone may make segments of length above 0.
    bool bounded = true;
    float farthest = std::numeric_limits<float>::infinity();
    TetOutline outline = {};
};

// Returns the outline of a tet with 1 to 3 front faces that are not seen edge-on. `block`: the
// pixels along a block's side.
TetOutline outline_of(const SilhouetteRecord& record, const PixelArea& area, int image_rows,
                      int block = TileGrid::block);

}  // namespace lamina
