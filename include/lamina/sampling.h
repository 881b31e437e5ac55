// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <memory>
#include <optional>
#include <string>

#include "lamina/export.h"
#include "lamina/mesh_data.h"
#include "lamina/volume.h"

namespace lamina {

// The field at a point. Both are NaN if a corner of the cell or tet there has no finite value.
struct FieldPoint {
    double value = 0;
    glm::dvec3 gradient{0};  // units of the value per world unit
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
// tets around it, weighted by volume, and linear in between. A call takes the time of a ray of the
// tracer.
class LAMINA_API FieldSampler {
  public:
    explicit FieldSampler(Volume volume);
    // `scalar`: name of the scalar; empty: the first one at points. Throws Error for a mesh without
    // tets or without such a scalar.
    explicit FieldSampler(MeshData mesh, const std::string& scalar = {});

    // Returns nothing outside the box of the volume or outside the tets. Faces count as inside;
    // on the boundary of a mesh that is not convex, rounding may decide otherwise.
    std::optional<FieldPoint> at(const glm::dvec3& position) const;

  private:
    struct Parts;
    std::shared_ptr<const Parts> parts_;
};

}  // namespace lamina
