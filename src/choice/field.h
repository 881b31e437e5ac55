// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "annotation/annotation_layer.h"
#include "choice/constant_border.h"
#include "choice/orientation.h"
#include "choice/value_distribution.h"
#include "choice/variation.h"
#include "lamina/scene.h"
#include "lamina/volume.h"
#include "mesh/tet_mesh.h"
#include "scene/scene.h"
#include "volume/min_max_bricks.h"
#include "volume/volume_data.h"

namespace lamina {

class Field;

// Layers of one value at a side of the data, which a clip may cut away.
struct BorderSide {
    double value = 0;        // of the layers
    double behind = 0;       // median of the first layer inside
    std::int64_t width = 0;  // samples
    ClipPlane inside{};      // keeps what is inside
};

// The data without the border around them (choice/constant_border.h).
struct BorderlessField {
    std::unique_ptr<Field> field;
    std::vector<BorderSide> sides;
};

// The data, a volume or a mesh, from which transfer function and camera are chosen.
class Field {
  public:
    virtual ~Field() = default;

    virtual WorldAxes axes() const = 0;  // named for meshes: in simulations z is up
    // Tells whether the data seem to be axial slices of a body from head to feet.
    virtual bool axial_slices() const { return false; }
    // Returns the axes of data that have one sample along a single axis; else nothing.
    virtual std::optional<SliceAxes> slice() const { return std::nullopt; }
    virtual Quantity quantity() const = 0;        // that the values measure
    virtual std::string length_unit() const = 0;  // of the world; empty if it is unknown
    virtual ValueRange range() const = 0;         // range of the finite values
    // Returns the world distance over which the data resolve changes: the least distance of samples
    // (infinite for a single one), or the mean edge of the tets.
    virtual double spacing() const = 0;
    virtual bool whole_numbers() const = 0;
    // Tells if a few whole numbers lie in pieces, as labels do, and not as noise or a rounded
    // field.
    virtual bool lies_in_pieces() const { return true; }
    // Returns the value around the data: of labels, that of all samples at the outer faces, else
    // that at all corners of a volume; nothing if they differ, or of large volumes of labels.
    virtual std::optional<double> value_around() const { return std::nullopt; }
    // Returns what the file says of labels, maybe nothing, if all values are labels; else null.
    virtual const VolumeLabels* labels() const { return nullptr; }
    // Returns the share of the field from which on a value may be padding (find_padding()).
    virtual double least_padding_share() const = 0;
    // Returns the distribution of the finite values by volume. Large data are sampled evenly.
    virtual ValueDistribution distribution() const = 0;

    // Returns the values, ascending, of the samples of which the clip keeps a part, if that is
    // quick to find; nothing else.
    virtual std::optional<std::vector<double>> kept_values(const Clip&) const {
        return std::nullopt;
    }

    // Returns the range of the finite values of what the clip keeps; empty if it keeps none. Of all
    // values in large volumes.
    virtual ValueRange kept_range(const Clip& clip) const = 0;

    // Measures how the field varies, in the bins of an empty Variation (variation_of()).
    virtual Variation variation(const ValueRange& measured, const Variation& bins) const = 0;
    // Tells whether the data end at the surface of a thing, as meshes do: then a faint outline of
    // everything shows where things are.
    virtual bool ends_at_surface() const { return false; }
    // Returns the share of that surface's area with values outside of a range.
    virtual double surface_outside(const ValueRange& /*range*/) const { return 0; }

    // Returns points whose convex hull holds all extinction above `least` >= 0 that the clip keeps,
    // and little more; empty if there is none.
    virtual std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function,
                                                 double least, const Clip& clip = {}) const = 0;
    virtual std::array<glm::dvec3, 8> corners() const = 0;
    // Tells whether a clip keeps nothing of the data, or of their box if this has more.
    virtual bool cut_away_by(const Clip& clip) const;

    // Returns the data without the border of constant values around them; nothing if they have
    // none.
    virtual std::optional<BorderlessField> without_border() const;

    // Returns the optical depths of about 1000 rays all over the scene's view; rays that miss the
    // data may be left out. Only transfer function, camera and size of the scene matter.
    virtual std::vector<double> optical_depths(const Scene& scene) const = 0;
};

// A volume with its bricks and, if counted, its values, all of which must outlive this object,
// which serves one thread at a time.
class VolumeField : public Field {
  public:
    VolumeField(const Volume& volume, const MinMaxBricks& bricks,
                const ValueCounts* values = nullptr, std::optional<ConstantBorder> border = {})
        : volume_(volume), bricks_(bricks), values_(values), border_(std::move(border)) {}
    explicit VolumeField(const VolumeData& data)
        : VolumeField(data.volume, data.bricks, data.values ? &*data.values : nullptr) {}

    WorldAxes axes() const override { return volume_.grid().axes; }
    bool axial_slices() const override;
    std::optional<SliceAxes> slice() const override;
    Quantity quantity() const override { return volume_.quantity(); }
    std::string length_unit() const override { return volume_.grid().unit; }
    ValueRange range() const override { return bricks_.whole; }
    double spacing() const override;
    bool whole_numbers() const override { return volume_.type() != SampleType::float32; }
    bool lies_in_pieces() const override;
    std::optional<double> value_around() const override;
    const VolumeLabels* labels() const override;
    double least_padding_share() const override { return least_padding; }
    ValueDistribution distribution() const override;
    // Returns nothing unless the samples are whole numbers in memory. A voxel is kept unless a
    // single plane cuts all of it away.
    std::optional<std::vector<double>> kept_values(const Clip& clip) const override;
    ValueRange kept_range(const Clip& clip) const override;
    Variation variation(const ValueRange& measured, const Variation& bins) const override {
        return variation_of(volume_, inside(), measured, bins);
    }
    std::optional<BorderlessField> without_border() const override;
    std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function, double least,
                                         const Clip& clip = {}) const override;
    std::array<glm::dvec3, 8> corners() const override;
    std::vector<double> optical_depths(const Scene& scene) const override;

  private:
    const Volume& volume_;
    const MinMaxBricks& bricks_;
    SampleBox inside() const;

    const ValueCounts* values_;              // null: distribution() counts the values
    std::optional<ConstantBorder> border_;   // left out of what is measured
    mutable std::optional<bool> in_pieces_;  // lies_in_pieces(), once measured
};

// A mesh with its scalar. The mesh must outlive this object, which serves one thread at a time.
class MeshField : public Field {
  public:
    explicit MeshField(const SceneMesh& mesh) : mesh_(mesh) {}

    WorldAxes axes() const override { return WorldAxes::named; }
    Quantity quantity() const override { return mesh_.quantity; }
    std::string length_unit() const override { return mesh_.length_unit; }
    ValueRange range() const override { return measure_range(mesh_.scalar.values).range; }
    double spacing() const override;                       // mean over the six edges of all tets
    bool whole_numbers() const override { return false; }  // false: tets interpolate values
    // 0, because a single vertex may mark missing data.
    double least_padding_share() const override { return 0; }
    // Tets count by their volume. A tet with a corner far from all other values (find_markers())
    // counts by its corners: values interpolated inside it were not measured.
    ValueDistribution distribution() const override;
    ValueRange kept_range(const Clip& clip) const override;
    Variation variation(const ValueRange& measured, const Variation& bins) const override {
        return variation_of(mesh_, measured, bins);
    }
    bool ends_at_surface() const override { return true; }
    double surface_outside(const ValueRange& range) const override;
    std::vector<glm::dvec3> shown_points(const TransferFunction& transfer_function, double least,
                                         const Clip& clip = {}) const override;
    std::array<glm::dvec3, 8> corners() const override;
    bool cut_away_by(const Clip& clip) const override {
        return !clip.keeps_all() && kept_by(clip) == nullptr;
    }
    std::vector<double> optical_depths(const Scene& scene) const override;

  private:
    // Returns what a clip keeps of the mesh; null if nothing is left. One clip in a row cuts once.
    const SceneMesh* kept_by(const Clip& clip) const;

    const SceneMesh& mesh_;
    mutable Clip clip_;  // of `kept_`
    mutable std::shared_ptr<const SceneMesh> kept_;
};

// Returns the diagonal of the data's box.
double diagonal_of(const Field& field);

// Returns what the wanted annotations tell of the data. For a colour bar the range is that of what
// the clip keeps, unless this is nothing. For a legend of labels the values are counted: it lists
// those that occur, without those of which the clip is known to keep nothing.
AnnotatedData annotated_data(const Field& field, const Annotations& wanted, const Clip& clip = {});

// Number of samples above which camera and extinctions are chosen from fewer samples, because the
// volume may stay on disk. In memory it is treated alike, so that its picture is the same.
constexpr std::int64_t large_volume = std::int64_t{1} << 28;

}  // namespace lamina
