// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/field.h"
#include "choice/padding.h"
#include "lamina/volume.h"
#include "volume/min_max_bricks.h"
#include "volume/value_counts.h"
#include "volume/volume_data.h"

namespace lamina {

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

}  // namespace lamina
