// SPDX-License-Identifier: Apache-2.0
// A picture is traced in tiles, each by one thread, which leaves out pixels that see nothing:
//   for each tile of the picture, from its middle to its edges, on all cores:
//       find the pixels whose lines may meet the volume's box or open faces of the mesh
//       for each of these pixels, row by row:
//           trace its ray (volume_tracer.cpp, mesh_tracer.cpp)
//       report that the tile is done
#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "base/client.h"
#include "lamina/image.h"
#include "lamina/settings.h"
#include "scene/camera.h"
#include "scene/clip.h"

namespace lamina {

class FaceTree;
class TetMesh;

struct TraceOptions {
    // Largest error of every channel, as a share of full scale (1.0); 1e-12 .. 1. For meshes it
    // bounds only the error of lighting: everything else is in closed form.
    double tolerance = 1e-5;
    // Must pass check_lighting(). check() throws Error if it has no smallest gradient.
    std::optional<Lighting> lighting = {};
    std::vector<HalfSpace> clip = {};  // half-spaces; a point is drawn if all of them contain it

    static constexpr double smallest_tolerance = 1e-12;  // below it rounding dominates
};

struct TraceTotals {
    // Estimated largest error of a channel, as a share of full scale (1.0). For volumes it leaves
    // out rounding (1e-14). For meshes it is the error of lighting and of rounded ends of segments.
    double error_estimate = 0;
    // Number of pieces with extinction that were integrated. For volumes a piece is the part of a
    // ray in one cell and one interval of the transfer function; for meshes, in one tet.
    std::int64_t segments = 0;
    // Number of rays on which a mesh overlaps itself; tets are composited in order of entry.
    std::int64_t overlapping_rays = 0;

    void add(const TraceTotals& other);
};
struct TraceResult : TraceTotals {
    PreciseImage image;  // associated RGBA in linear light, before any background
};

void check(const TraceOptions& options);

using RowDone = std::function<void()>;  // called after each finished row of a tile

// Called with each tile that is done, by one thread at a time. Pixels of other tiles are not final.
using TileDone = std::function<void(const PictureTile&, const PreciseImage&)>;

// Returns tiles of 32 x 32 pixels, smaller at edges, those nearest the picture's middle first.
std::vector<PictureTile> tiles_to_trace(int width, int height);

// Calls trace(tile, picture, row_done) for each tile in order, on all cores, and `done` after each.
TraceResult trace_tiles(
    const View& view,
    const std::function<TraceTotals(const PictureTile&, PreciseImage&, const RowDone&)>& trace,
    const TileDone& done);

// Hands out the pixels of a rectangle, row by row. Throws when the user interrupts.
class PixelsInTurn {
  public:
    PixelsInTurn(const glm::ivec2& first, const glm::ivec2& last, RowDone row_done)
        : first_(first), last_(last), next_(first), row_done_(std::move(row_done)) {}

    bool any() const { return next_.x <= last_.x && next_.y <= last_.y; }
    glm::ivec2 take() {
        const glm::ivec2 pixel = next_;
        check_interrupt();
        if (pixel.x == first_.x && pixel.y > first_.y) row_done_();
        next_ = pixel.x < last_.x ? pixel + glm::ivec2(1, 0) : glm::ivec2(first_.x, pixel.y + 1);
        return pixel;
    }

  private:
    glm::ivec2 first_, last_, next_;
    RowDone row_done_;
};

// A rectangle of pixels of a tile, counted from the tile's first: from `first` to `last`.
struct SeenPixels {
    glm::ivec2 first, last;

    bool empty() const { return first.x > last.x || first.y > last.y; }
};

// Finds the pixels of a tile that may see some points.
class TileSight {
  public:
    TileSight(const View& view, const PictureTile& tile);

    // Returns the pixels whose lines (rays, extended back) may meet the hull of some points.
    SeenPixels around(std::span<const glm::dvec3> points) const;

  private:
    const View& view_;
    glm::ivec2 size_;
    glm::dvec2 middle_;  // the picture's centre, in pixels from the tile's first pixel's centre
    double error_;       // bounds the error of projected points, as a share of their distance
    double eye_norm_;    // 1-norm of the eye's position
};

// The open faces that a tile's lines may meet, listed once instead of searched for each pixel.
class TileFaces {
  public:
    TileFaces(const TetMesh& mesh, const FaceTree& open_faces, const View& view)
        : mesh_(mesh), tree_(open_faces), view_(view) {}

    // Lists the faces of a tile. Returns false if there are too many to be listed.
    bool list(const PictureTile& tile);

    // Returns the faces of a pixel of the picture in the tile: indices into open_faces().
    std::span<const std::int32_t> of(const glm::ivec2& pixel) const;

  private:
    struct ListedFace {
        std::int32_t face;
        SeenPixels pixels;
    };
    template <typename Visit>
    void for_each_pixel(const Visit& visit) const;

    const TetMesh& mesh_;
    const FaceTree& tree_;
    const View& view_;
    PictureTile tile_{};
    std::vector<ListedFace> faces_;
    std::vector<std::int32_t> listed_;  // the lists of all pixels, one after the other
    std::vector<std::size_t> begins_;   // index in listed_ of each list; then listed_.size()
};

}  // namespace lamina
