// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

#include "choice/value_distribution.h"
#include "lamina/grid.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "mesh/tet_mesh.h"
#include "scene/scene_mesh.h"
#include "volume/min_max_bricks.h"
#include "volume/value_counts.h"
#include "volume/volume_data.h"

namespace lamina {

// The data that choices are made from, a volume or a mesh, reduced to what choices need.
class Field {
  public:
    virtual ~Field() = default;

    virtual WorldAxes axes() const = 0;
    virtual ValueRange range() const = 0;  // range of the finite values
    // Returns the world distance over which the scalar is known to change: the smallest distance of
    // neighbouring samples (infinite if no axis has two), or the mean edge of the tets.
    virtual double spacing() const = 0;
    // Tells whether all values are whole, as labels are.
    virtual bool whole_numbers() const = 0;
    // Returns the share of the field that a value must have to be padding
    // (choice/value_distribution.h).
    virtual double least_padding_share() const = 0;
    // Returns the distribution of the finite values, by volume; large data are sampled evenly.
    // Empty if none is finite.
    virtual ValueDistribution distribution() const = 0;

    // Returns points whose hull contains everything with more than `least` >= 0 extinction: corners
    // of parts of the data. Empty if there is nothing.
    virtual std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                                 double least) const = 0;
    // The corners of the data's bounding box.
    virtual std::array<glm::dvec3, 8> corners() const = 0;

    // Returns the optical depths of about 1000 rays of the scene's view, spread over the picture;
    // rays that miss the data may be left out. Only transfer function, camera and size of the scene
    // matter.
    virtual std::vector<double> optical_depths(const Scene& scene) const = 0;
};

// A volume with its bricks, and with its values if these are counted already. All must outlive this
// object.
class VolumeField : public Field {
  public:
    VolumeField(const Volume& volume, const MinMaxBricks& bricks)
        : volume_(volume), bricks_(bricks) {}
    explicit VolumeField(const VolumeData& data)
        : volume_(data.volume),
          bricks_(data.bricks),
          values_(data.values ? &*data.values : nullptr) {}

    WorldAxes axes() const override { return volume_.grid().axes; }
    ValueRange range() const override { return bricks_.whole; }
    double spacing() const override;
    bool whole_numbers() const override { return volume_.type() != SampleType::float32; }
    double least_padding_share() const override { return least_padding; }
    ValueDistribution distribution() const override;
    // Returns corners of cells.
    std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                         double least) const override;
    std::array<glm::dvec3, 8> corners() const override;
    // Integrates by a few steps a voxel.
    std::vector<double> optical_depths(const Scene& scene) const override;

  private:
    const Volume& volume_;
    const MinMaxBricks& bricks_;
    const ValueCounts* values_ = nullptr;  // null: not counted yet
};

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
