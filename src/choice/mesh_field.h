// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/field.h"
#include "mesh/tet_mesh.h"
#include "scene/scene_mesh.h"

namespace lamina {

// A mesh with its scalar, which must outlive this.
class MeshField : public Field {
  public:
    explicit MeshField(const SceneMesh& mesh) : mesh_(mesh) {}

    WorldAxes axes() const override { return WorldAxes::unnamed; }
    ValueRange range() const override { return measure_range(mesh_.scalar.values).range; }
    double spacing() const override;                       // each tet's edges count
    bool whole_numbers() const override { return false; }  // it interpolates between them
    // A single vertex may mark missing data.
    double least_padding_share() const override { return 0; }
    // Tets count by their volume. Those with a corner far from all other values (find_markers())
    // count by their corners: what lies between was not measured.
    ValueDistribution distribution() const override;
    // Corners of tets.
    std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                         double least) const override;
    std::array<glm::dvec3, 8> corners() const override;
    // From tet to tet, in closed form.
    std::vector<double> optical_depths(const Scene& scene) const override;

  private:
    const SceneMesh& mesh_;
};

}  // namespace lamina
