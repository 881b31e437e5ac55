// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lamina/error.h"

namespace lamina {

// Extent of a volume's box along an axis. node: from the first sample to the last. cell: half a
// voxel more at each end, where the border value repeats. A single sample along an axis is one
// voxel wide with either.
enum class Centering { node, cell };

// The field between samples. linear: trilinear. nearest: each sample's value holds in its voxel,
// half a step around it; for labels, between which no other values lie.
enum class VolumeLookup { linear, nearest };

// Directions in a patient's body in which the world's x, y and z grow, if the file says so: z then
// grows towards the head. named: the file has names for its axes, which are x, y and z, and z is
// up.
enum class WorldAxes {
    unnamed,
    left_posterior_superior,
    right_anterior_superior,
    left_anterior_superior,
    named
};

// Places of the samples of a regular grid in the world. In index space sample (i, j, k) lies at (i,
// j, k); if `lookup` is nearest, its voxel reaches from there to (i + 1, j + 1, k + 1). So cells of
// the field lie between whole numbers with both. `centering` sets the extent of the rendered box
// along each axis.
struct LAMINA_API Grid {
    std::array<std::int64_t, 3> size{1, 1, 1};
    std::array<Centering, 3> centering{Centering::node, Centering::node, Centering::node};
    glm::dvec3 origin{0};  // world position of sample (0, 0, 0)
    std::array<glm::dvec3, 3> step{glm::dvec3{1, 0, 0}, glm::dvec3{0, 1, 0},
                                   glm::dvec3{0, 0, 1}};  // orthogonal
    WorldAxes axes = WorldAxes::unnamed;                  // used by the automatic camera only
    // Unit of lengths in the world, as the file names it, such as "mm"; empty if it names none.
    std::string unit;
    VolumeLookup lookup = VolumeLookup::linear;

    std::int64_t sample_count() const { return size[0] * size[1] * size[2]; }
    // Returns the index of sample 0, along each axis: the middle of its voxel if lookup is nearest.
    double first_sample() const { return lookup == VolumeLookup::nearest ? 0.5 : 0.0; }
    glm::dvec3 index_min() const;  // lowest corner of the box, index space
    glm::dvec3 index_max() const;
    glm::dvec3 index_origin() const;  // world position of index (0, 0, 0)
    glm::dvec3 to_world(const glm::dvec3& index) const;
    glm::dvec3 to_index(const glm::dvec3& world) const;
    // Converts a direction: without translation.
    glm::dvec3 direction_to_index(const glm::dvec3& world) const;

    struct Bounds {
        glm::dvec3 min{0}, max{0};
    };
    Bounds bounds() const;  // axis-aligned, world
};

enum class SampleType { uint8, int16, uint16, float32 };

LAMINA_API std::size_t bytes_of(SampleType type);
LAMINA_API const char* name_of(SampleType type);  // "uint8", "int16", "uint16", "float"

class VolumeStore;

// Quantity that samples measure, as a file names it; each text is empty if the file does not say.
struct Quantity {
    std::string name, unit;

    friend bool operator==(const Quantity&, const Quantity&) = default;
};

// A label of a volume whose samples are labels (docs/scene.md, "Labels").
struct Label {
    double code = 0;                    // value of its samples
    std::string number;                 // the file's number for it, in decimal digits
    std::string name{};                 // empty if the file gives none
    std::optional<glm::dvec3> color{};  // linear light; empty if the file gives none
    double opacity = 1;                 // as the file says, from 0 to 1; 0: shows nothing
};

// Labels of which a file says more than its samples do, in the order of their codes.
struct VolumeLabels {
    // True if codes stand for the file's numbers, which samples cannot hold; all labels are listed.
    bool renumbered = false;
    std::vector<Label> list;
};

// Scalars on a regular grid, in the file's own type; x changes fastest. A volume is immutable, and
// copies share the samples. Volumes that do not fit the memory limit (lamina/volume.h) stay in
// their files, and parts of them are read when they are drawn; the functions of the public headers
// return and take only volumes in memory.
class Volume {
  public:
    // `samples`: grid.sample_count() values of `type` in native byte order.
    Volume(Grid grid, SampleType type, std::shared_ptr<const void> samples)
        : grid_(grid), type_(type), samples_(std::move(samples)) {}
    // A volume that stays in its files.
    Volume(Grid grid, SampleType type, std::shared_ptr<const VolumeStore> store)
        : grid_(grid), type_(type), store_(std::move(store)) {}

    const Grid& grid() const { return grid_; }
    SampleType type() const { return type_; }
    bool in_memory() const { return store_ == nullptr; }
    const VolumeStore& store() const { return *store_; }  // the volume must not be in memory
    const void* data() const { return samples_.get(); }   // null if the volume is not in memory
    const std::shared_ptr<const void>& shared_data() const { return samples_; }
    // Returns what the file says of its labels; null if it says nothing.
    const std::shared_ptr<const VolumeLabels>& labels() const { return labels_; }
    // Returns the same samples with other labels.
    Volume labelled(std::shared_ptr<const VolumeLabels> labels) const {
        Volume other = *this;
        other.labels_ = std::move(labels);
        return other;
    }
    const Quantity& quantity() const { return quantity_; }
    // Returns the same samples of another quantity.
    Volume measuring(Quantity quantity) const {
        Volume other = *this;
        other.quantity_ = std::move(quantity);
        return other;
    }
    // Returns the same samples on another grid, which must have the same number of them along each
    // axis.
    Volume on(const Grid& grid) const {
        Volume placed = *this;
        placed.grid_ = grid;
        return placed;
    }
    bool shares_samples(const Volume& other) const {
        return samples_ == other.samples_ && store_ == other.store_;
    }
    std::size_t byte_count() const {
        return static_cast<std::size_t>(grid_.sample_count()) * bytes_of(type_);
    }

    // Calls visitor(pointer to the first sample); the volume must be in memory. The pointer has the
    // type of the samples: std::uint8_t, std::int16_t, std::uint16_t or float.
    template <typename Visitor>
    decltype(auto) visit(Visitor&& visitor) const {
        switch (type_) {
            case SampleType::uint8:
                return visitor(static_cast<const std::uint8_t*>(data()));
            case SampleType::int16:
                return visitor(static_cast<const std::int16_t*>(data()));
            case SampleType::uint16:
                return visitor(static_cast<const std::uint16_t*>(data()));
            case SampleType::float32:
                return visitor(static_cast<const float*>(data()));
        }
        __builtin_unreachable();  // there is a case for every value
    }

  private:
    Grid grid_;
    SampleType type_;
    std::shared_ptr<const void> samples_;
    std::shared_ptr<const VolumeStore> store_;
    std::shared_ptr<const VolumeLabels> labels_;
    Quantity quantity_;
};

// Layout of the samples in a file without a header; x changes fastest.
struct RawLayout {
    std::array<std::int64_t, 3> size{1, 1, 1};  // samples along x, y and z
    // int8, uint8, int16, uint16, int32, uint32, int64, uint64, float or double
    std::string type = "uint8";
    std::int64_t offset = 0;  // bytes before the first sample
    bool big_endian = false;

    bool operator==(const RawLayout&) const = default;
};

// Selects a volume of a data file that holds several, and gives what the file itself does not say
// (docs/scene.md, "What is drawn"). Numbers count from 0.
struct LAMINA_API VolumeRequest {
    std::string array;  // name of the array; empty for the first
    // Level of a resolution pyramid, component of the samples, step in time. If none is given the
    // first one is taken, with a warning.
    std::optional<std::int64_t> level, channel, time;
    // Distances between samples, above 0, and place of the first one, instead of the file's.
    std::optional<glm::dvec3> spacing;
    std::optional<glm::dvec3> origin;
    std::optional<RawLayout> raw;  // must be given if the file has no header
    // If none is given: nearest if the samples are labels (docs/scene.md, "Labels"), else linear.
    std::optional<VolumeLookup> lookup;

    bool operator==(const VolumeRequest&) const = default;
};

// Asks for a volume that is made by a formula (docs/scene.md, volume.generate).
struct GeneratorRequest {
    std::string name;  // "gaussians", "ramp", ...: docs/scene.md
    // Samples along x, y and z. Without a size a volume has 128^3 samples, and a ramp 256 x 4 x 1.
    std::optional<std::array<std::int64_t, 3>> size;
    SampleType type = SampleType::uint8;  // or uint16, float32
    VolumeLookup lookup = VolumeLookup::linear;

    bool operator==(const GeneratorRequest&) const = default;
};

// Memory that the process may take for data, in bytes. Volumes that a scene names and that do not
// fit stay in their files, and parts of them are read when they are drawn. The default is half of
// the machine's memory, or of its control group's. A change counts for volumes that are opened
// later.
LAMINA_API std::uint64_t memory_limit();
LAMINA_API void set_memory_limit(std::uint64_t bytes);  // 0: the default

// Reads a volume of any kind that scenes may name (docs/scene.md, "What is drawn"). If `only_below`
// is a folder, this function, like all others with this argument, refuses files that are not below
// the folder once all links are followed, whoever names them (docs/files.md). Throws Error: one
// line that names the file, what was found and what was expected. What is noteworthy, such as which
// of several channels is read, or that samples are taken for labels, is put
// into `warnings`.
LAMINA_API Volume load_volume(const std::filesystem::path& file, const VolumeRequest& request = {},
                              const std::filesystem::path& only_below = {},
                              std::vector<std::string>* warnings = nullptr);

// Makes a volume of labels from grid.sample_count() numbers in memory, as from a file: samples are
// the first of uint8, int16 and uint16 that holds all of them, else codes (VolumeLabels). Numbers
// that are not whole, or more than 65,535 different ones, become float. `type`: as in RawLayout.
LAMINA_API Volume label_volume(const Grid& grid, const std::string& type,
                               std::shared_ptr<const void> samples,
                               std::vector<std::string>* warnings = nullptr);

// Writes a volume as .nrrd, from which load_volume() reads the same bits, and the same labels. The
// file appears under its name when it is complete. Throws Error, also for other suffixes.
LAMINA_API void save_volume(const Volume& volume, const std::filesystem::path& file);

}  // namespace lamina
