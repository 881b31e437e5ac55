// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "facts/bricks.h"
#include "lamina/scene.h"
#include "lamina/settings.h"
#include "lamina/volume.h"
#include "scene/camera.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// A plane of a clip in a grid's index space: points at distances >= 0 are kept.
struct IndexPlane {
    glm::dvec3 normal{0};  // of length 1
    double offset = 0;

    double distance(const glm::dvec3& index) const;
    // Returns this plane in the index space of a part of the grid that begins at sample `first`.
    IndexPlane seen_from(const glm::dvec3& first) const { return {normal, distance(first)}; }
    // Return the least and the largest distance of a box's points.
    double least_distance(const glm::dvec3& min, const glm::dvec3& max) const;
    double largest_distance(const glm::dvec3& min, const glm::dvec3& max) const;

    friend bool operator==(const IndexPlane&, const IndexPlane&) = default;
};

// Returns all planes of the clip, the box's six last.
std::vector<IndexPlane> index_planes(const Clip& clip, const Grid& grid);
// Returns those of `planes` that cut something off the grid's box.
std::vector<IndexPlane> cutting_planes(std::vector<IndexPlane> planes, const Grid& grid);

// A box in index space.
struct IndexBox {
    glm::dvec3 min{0}, max{0};
    bool empty() const { return !(min.x < max.x && min.y < max.y && min.z < max.z); }

    friend bool operator==(const IndexBox&, const IndexBox&) = default;
};

// Eye-space depths of a box's nearest (>= 0) and farthest point; far <= near: behind the eye.
struct DepthRange {
    double near = 0;
    double far = 0;
};
DepthRange depth_range(const Grid& grid, const View& view);
DepthRange depth_range(const Grid& grid, const IndexBox& box, const View& view);

// Shares of the steps on rays all over the picture that lie in the clipped box, in visible bricks
// and in constant ones (Facts::constant_bricks). Plans predict work by them. *_before_opaque count
// only steps in front of the depth at which their ray ends (opaque_depth()).
struct RayShares {
    double box = 0, occupied = 0, constant = 0;
    double box_before_opaque = 0, occupied_before_opaque = 0, constant_before_opaque = 0;
};

// Scalars along rays of the view, on which pre-integration tables are tried.
struct ScalarRays {
    struct Ray {
        double length_per_depth = 1;  // world length per unit of eye-space depth
        double near = 0, far = 0;     // eye-space depths where it enters and leaves the clipped box
        // The scalar, and the optical depth in front of it, at evenly spaced depths.
        std::vector<float> scalars;
        std::vector<float> optical_depths;
    };
    std::vector<Ray> rays;  // all over the picture, each through the box
};

// Properties of a volume and its view. They are measured, not taken from the headers of files.
struct Facts {
    Grid grid;
    SampleType type = SampleType::uint8;
    ValueRange range;             // range of the finite samples
    std::int64_t non_finite = 0;  // number of NaN or infinite samples

    std::vector<IndexPlane> clip;  // all planes of the scene's clip

    double side_ratio = 1;  // longest side of the box over the shortest, in the world

    // The following describe the transfer function over `range`.
    bool constant = false;      // one colour, one extinction
    bool single_color = false;  // one colour wherever extinction is > 0
    double max_extinction = 0;  // per world unit
    double max_color = 0;       // largest component of a colour
    std::int64_t knots = 0;     // number of knots strictly inside the range
    std::int64_t pieces = 1;    // number of linear pieces over drawn_range()
    std::int64_t curves = 1;    // number of pieces if curves follow smooth points (optics/pieces.h)

    // The smallest box of bricks around all that the clip leaves visible.
    IndexBox occupied;
    bool clipped_away = false;  // something is visible without the clip, and nothing with it
    OccupiedBricks occupied_bricks;
    double occupied_share = 0;  // share of the bricks that are visible
    DepthRange occupied_depth;  // eye-space depths of `occupied`
    ConstantBricks constant_bricks;
    // Quantiles .5, .9 and 1 of the largest extinctions of the bricks, per world unit.
    std::array<double, 3> extinction_quantiles{};

    // The following describe the view. near_depth and far_depth are the eye-space depths of the
    // nearest and the farthest point of the box in front of the eye.
    bool orthographic = false;
    bool eye_inside = false;
    double near_depth = 0;
    double far_depth = 0;          // <= near_depth if the whole box lies behind the eye
    double voxels_along_view = 0;  // from near_depth to far_depth along the view axis
    // World length of the longest pixel ray per unit of depth (1 for orthographic views).
    double max_length_per_depth = 1;

    RayShares ray_shares;
    ScalarRays scalar_rays;  // filled if segments are pre-integrated and a table may be needed
};

// Measures all facts. Throws Error as check_finite() does.
Facts measure(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks);

// Parts of measure(): volume and transfer function; the view without rays; what its rays meet, and
// the scalars along them. The latter two take grid, bricks and depths from `facts`.
Facts measure_data(const Scene& scene, const Volume& volume, const MinMaxBricks& bricks);
void measure_view(const Scene& scene, Facts& facts);
RayShares measure_ray_shares(const Scene& scene, const Volume& volume, const Facts& facts);
ScalarRays measure_scalar_rays(const Scene& scene, const Volume& volume, const Facts& facts);

// Throws Error if no sample is finite, or if some are not while the scene's `nan` is "error".
void check_finite(const Scene& scene, const Grid& grid, const MinMaxBricks& bricks);

// Share of max_error that the end of a ray may cost: what lies behind changes no channel by more.
// Errors of tables and roundings are larger, so rays may end there while these are measured, too.
inline constexpr double hidden_share = 1.0 / 1024;

// Returns the optical depth behind which a channel changes by at most hidden_share of max_error.
double opaque_depth(double max_error, double max_color);

// Largest number of sampled rays, and of scalars on a ray.
struct RaySampling {
    std::size_t rays = 1024;
    double scalars = 1024;
};

// Samples rays of the view. `bricks`: the volume's own, which save reading samples, or null.
ScalarRays sample_rays(const Scene& scene, const Volume& volume, const Facts& facts,
                       const MinMaxBricks* bricks = nullptr, const RaySampling& sampling = {});

}  // namespace lamina
