// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/field.h"
#include "mesh/scalar_range.h"
#include "scene/scene_mesh.h"

namespace lamina {

// A mesh with its scalar. The mesh must outlive this object.
class MeshField : public Field {
  public:
    explicit MeshField(const SceneMesh& mesh) : mesh_(mesh) {}

    WorldAxes axes() const override { return WorldAxes::unnamed; }
    ValueRange range() const override { return measure_range(mesh_.scalar.values).range; }
    double spacing() const override;                       // the mean over the edges of each tet
    bool whole_numbers() const override { return false; }  // false: tets interpolate
    // A single vertex may mark missing data.
    double least_padding_share() const override { return 0; }
    // Tets count by their volume. A tet with a corner far from all other values (find_markers())
    // counts by its corners: values interpolated inside it were not measured.
    ValueDistribution distribution() const override;
    // Returns corners of tets.
    std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                         double least) const override;
    std::array<glm::dvec3, 8> corners() const override;
    // Integrates from tet to tet, in closed form.
    std::vector<double> optical_depths(const Scene& scene) const override;

  private:
    const SceneMesh& mesh_;
};

}  // namespace lamina
