// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lamina/error.h"
#include "lamina/mesh.h"
#include "lamina/volume.h"

namespace lamina {

// The field at a point. Both are NaN if a corner of the cell or tet there has no finite value.
struct FieldPoint {
    double value = 0;
    glm::dvec3 gradient{0};  // units of the value per world unit
};

// A segment of a ray inside one cell of a volume or one tet: between its ends the field has no
// kink.
struct RaySegment {
    double begin = 0, end = 0;   // distances from the ray's origin, world; begin < end
    double least = 0, most = 0;  // bounds of the field; NaN if a corner has no finite value
};

// Samples the field that pictures show, for those who write their own integrator. Copies are cheap,
// and any threads may share one.
//
// In a volume the value is trilinear between samples. The gradient is the one that light sees: from
// differences of neighbouring samples, trilinear between them (docs/numerics.md, section 10). Both
// are exact for linear fields. In the half voxels of `cell` axes the border's value and gradient
// repeat.
//
// In a mesh the value is linear in each tet. The gradient at a point of the mesh is the mean of the
// tets around it, weighted by volume, and linear in between. A call of at() takes as long as a ray
// of the reference tracer.
class LAMINA_API FieldSampler {
  public:
    explicit FieldSampler(Volume volume);
    // `scalar`: name of the scalar; empty: the first one at points. Throws Error for a mesh without
    // tets or without such a scalar.
    explicit FieldSampler(MeshData mesh, const std::string& scalar = {});

    // Returns the field at a point in the world, or nothing outside the box of the volume or
    // outside the tets. Faces count as inside; on the boundary of a mesh that is not convex,
    // rounding may decide otherwise.
    std::optional<FieldPoint> at(const glm::dvec3& position) const;

    // Returns the segments of the ray from `origin` in `direction` (of any finite length above 0;
    // for others the list is empty), front to back. Between two segments there may be a gap: where
    // the ray is outside the mesh, or by rounding.
    std::vector<RaySegment> along(const glm::dvec3& origin, const glm::dvec3& direction) const;

  private:
    struct Parts;
    std::shared_ptr<const Parts> parts_;
};

// Point at which a ray has half of its opacity: what an eye takes for the place of what it sees.
struct SeenPoint {
    glm::dvec3 position{0};  // world
    double value = 0;        // value of the data there
    double opacity = 0;      // opacity of the whole ray, 0..1
};

// Finds the point of the data that is seen at a place of a picture. Session::probe() makes it from
// the scene and the data as they are then. A copy is cheap, and any thread may use it while the
// session goes on.
class LAMINA_API PointProbe {
  public:
    struct Parts;
    explicit PointProbe(std::shared_ptr<Parts> parts);

    // Returns the point that is seen at (column, row), or nothing if the ray there has no opacity.
    // Whole numbers are the centres of pixels, row 0 on top; fractions and places outside the
    // picture are allowed.
    std::optional<SeenPoint> seen(double column, double row) const;

  private:
    std::shared_ptr<Parts> parts_;
};

}  // namespace lamina
