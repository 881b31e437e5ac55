// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_opening.h"

#include <fmt/format.h>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "base/error.h"
#include "base/memory.h"
#include "mesh/predicates.h"
#include "volume/volume_store.h"
#include "volume_files/sample_sources.h"

namespace lamina {
namespace {

// Largest cosine of the angle between directions that count as orthogonal: headers print some 6
// digits, and this moves samples by less than a hundredth of a voxel over 1000 voxels.
constexpr double orthogonal_cosine = 1e-5;

// Largest deviation from a right angle that is mended, in degrees: headers that round to 3 digits,
// and registrations, cause no more.
constexpr double mended_degrees = 0.1;

// Steps outside of this range would overflow or vanish when squared.
constexpr double shortest_step = 1e-100;
constexpr double longest_step = 1e100;

// Returns the orthogonal directions nearest to `directions`, the factor of their polar
// decomposition, by Newton's iteration X -> (X + X^-T) / 2 (Higham, Computing the polar
// decomposition, SIAM J. Sci. Stat. Comput. 7, 1986, section 3).
glm::dmat3 nearest_orthogonal(glm::dmat3 directions) {
    // The iteration squares the error, at most .002 at first: after 3 steps it is below rounding.
    for (int round = 0; round < 4; ++round)
        directions = 0.5 * (directions + glm::transpose(glm::inverse(directions)));
    return directions;
}

// Returns how far the samples of `to` lie at most from those of `from`: the largest distance
// between the corners of both, because the distance is convex.
double largest_shift(const Grid& from, const Grid& to) {
    const glm::dvec3 last = glm::dvec3(from.size[0], from.size[1], from.size[2]) - 1.;
    double largest = 0;
    for (const glm::dvec3& index : box_corners(glm::dvec3(0), last))
        largest = std::max(largest, glm::distance(from.to_world(index), to.to_world(index)));
    return largest;
}

void make_orthogonal(const std::string& file, Grid& grid, const GridWords& words) {
    glm::dmat3 directions;
    for (std::size_t i = 0; i < 3; ++i)
        directions[static_cast<int>(i)] = glm::normalize(grid.step[i]);
    double worst = 0;  // in degrees
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double cosine = glm::dot(directions[i], directions[j]);
        const double beyond = glm::degrees(std::asin(std::clamp(std::abs(cosine), 0.0, 1.0)));
        if (beyond > mended_degrees) {
            fail("{}: {}: axes {} and {} meet at {:.4f} degrees, expected 90", file,
                 words.directions, std::min(i, j), std::max(i, j),
                 glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))));
        }
        worst = std::max(worst, beyond);
    }
    if (worst <= glm::degrees(orthogonal_cosine)) return;
    const Grid found = grid;
    const glm::dmat3 orthogonal = nearest_orthogonal(directions);
    for (std::size_t i = 0; i < 3; ++i)
        grid.step[i] = orthogonal[static_cast<int>(i)] * glm::length(grid.step[i]);
    say("{}: {}: axes are up to {:.2g} degrees from right angles: the nearest "
        "orthogonal ones are taken, which moves samples by up to {:.2g}",
        file, words.directions, worst, largest_shift(found, grid));
}

}  // namespace

void check_grid(const std::string& file, Grid& grid, const GridWords& words) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double length = std::hypot(grid.step[i].x, grid.step[i].y, grid.step[i].z);
        if (!(length >= shortest_step && length <= longest_step)) {
            fail("{}: axis {}: found a distance of {} between samples, expected one from {} to {}",
                 file, i, length, shortest_step, longest_step);
        }
        if (!(std::abs(grid.origin[static_cast<int>(i)]) <= longest_step)) {
            fail("{}: {}: found {}, expected finite numbers up to {}", file, words.origin,
                 grid.origin[static_cast<int>(i)], longest_step);
        }
    }
    make_orthogonal(file, grid, words);
}

glm::dvec3 slice_step(const glm::dvec3& first, const glm::dvec3& second) {
    const double least = std::min(glm::length(first), glm::length(second));
    if (!(least > 0)) return glm::dvec3(0);
    const glm::dvec3 along = glm::normalize(first);
    glm::dvec3 normal = glm::cross(along, glm::normalize(second));
    if (normal == glm::dvec3(0)) {
        const bool is_x = std::abs(along.x) > .5;
        normal = glm::cross(along, is_x ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
    }
    return least * glm::normalize(normal);
}

void turn_to_lps(Grid& grid, WorldAxes axes) {
    if (axes == WorldAxes::unnamed) return;
    const glm::dvec3 turn{axes == WorldAxes::right_anterior_superior ? -1 : 1,
                          axes == WorldAxes::left_posterior_superior ? 1 : -1, 1};
    constexpr double zero = 0;  // -0 becomes 0
    grid.origin = grid.origin * turn + zero;
    for (glm::dvec3& step : grid.step) step = step * turn + zero;
    grid.axes = WorldAxes::left_posterior_superior;
}

std::string unit_word(std::string_view found) {
    constexpr std::string_view blanks = " \t\r\n";
    constexpr std::size_t longest = 32;
    const std::size_t first = found.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    found = found.substr(first, found.find_last_not_of(blanks) - first + 1);
    const bool is_word =
        found.size() <= longest && std::ranges::none_of(found, [](char letter) {
            return static_cast<unsigned char>(letter) < ' ' || letter == '"' || letter == '\\';
        });
    return is_word ? std::string(found) : std::string();
}

double metres_of(std::string_view unit) {
    struct Length {
        std::string_view words;  // between blanks
        double metres;
    };
    constexpr Length lengths[] = {
        {" km kilometre kilometer kilometres kilometers ", 1e3},
        {" m metre meter metres meters ", 1},
        {" dm decimetre decimeter decimetres decimeters ", .1},
        {" cm centimetre centimeter centimetres centimeters ", 1e-2},
        {" mm millimetre millimeter millimetres millimeters ", 1e-3},
        {" um \u00b5m \u03bcm micron microns micrometre micrometer micrometres micrometers ", 1e-6},
        {" nm nanometre nanometer nanometres nanometers ", 1e-9},
        {" A \u00c5 angstrom angstroms ", 1e-10},
        {" pm picometre picometer picometres picometers ", 1e-12},
        {" ft foot feet ", .3048},
        {" in inch inches ", .0254},
        {" thou ", 2.54e-5}};
    const std::string whole = fmt::format(" {} ", unit);
    for (const Length& length : lengths)
        if (length.words.find(whole) != std::string_view::npos) return length.metres;
    return 0;
}

void unite_units(const std::string& name, Grid& grid, const std::array<std::string, 3>& units) {
    for (const std::string& unit : units)
        if (grid.unit.empty()) grid.unit = unit;
    std::array<std::string, 3> words = units;
    std::ranges::replace(words, std::string(), std::string("none"));
    bool differ = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const double from = metres_of(units[i]), to = metres_of(grid.unit);
        const bool are_degrees = units[i].starts_with("degree") && grid.unit.starts_with("degree");
        if (units[i] == grid.unit || units[i].empty() || are_degrees) continue;
        if (from == 0 || to == 0) {
            differ |= grid.size[i] > 1;
            continue;
        }
        const int along = static_cast<int>(i);
        for (glm::dvec3& step : grid.step) step[along] *= from / to;
        grid.origin[along] *= from / to;
    }
    if (differ) {
        say("{}: the axes x, y and z have the units {}: their numbers are taken as "
            "they are, \"spacing\" in the volume gives others",
            name, fmt::join(words, ", "));
    }
}

namespace {

// Bytes that drawing takes for each min/max brick of 64 samples, beside the brick's range: if it
// shows something, if it is constant, and how rays leap over it.
constexpr double bytes_per_brick = 4, samples_per_brick = 64;

constexpr double gradient_bytes = 8, float_bytes = 4;  // for each sample

}  // namespace

void take_for_labels(const std::string& file, const std::string& who, const VolumeUse& use,
                     Grid& grid) {
    if (use.lookup) return;
    grid.lookup = VolumeLookup::nearest;
    say("{}: its samples are labels, as {} says; \"lookup\": \"linear\" in the volume "
        "would interpolate between them",
        file, who);
}

bool stays_in_files(const Grid& grid, SampleType type, const VolumeUse& use) {
    if (use.residence != VolumeUse::Residence::as_fits)
        return use.residence != VolumeUse::Residence::in_memory;
    const auto samples = static_cast<double>(grid.sample_count());
    const auto each = static_cast<double>(bytes_of(type));
    double bytes = samples * (each + (2 * each + bytes_per_brick) / samples_per_brick);
    if (type == SampleType::float32)
        bytes += samples * float_bytes;  // the normalised copy
    else if (samples * each > std::numeric_limits<std::int32_t>::max())
        bytes += samples * each;  // copies in bricks with 32-bit indices
    if (use.lit) bytes += samples * gradient_bytes;
    return bytes > static_cast<double>(memory_limit());
}

void expect_room(const std::string& name, std::uint64_t bytes, const VolumeUse& use,
                 const std::string& why) {
    using Residence = VolumeUse::Residence;
    if (use.residence == Residence::in_memory || use.residence == Residence::in_order) return;
    if (use.residence == VolumeUse::Residence::in_files) {
        fail(
            "{}: {}, so it cannot stay in its file: expected raw data of uint8, int16, uint16 or "
            "float samples, not scaled, or such samples in Zarr or HDF5; lamina index --bricks "
            "makes a copy of it that can",
            name, why);
    }
    if (memory_limit_is_given() && bytes > memory_limit()) {
        fail(
            "{}: {}, so all {} bytes of its samples would be in memory, more than the limit of {}: "
            "lamina index --bricks makes a copy of it that is read by parts",
            name, why, bytes, memory_limit());
    }
}

Volume stored_volume(const Grid& grid, SampleType type,
                     std::unique_ptr<const SampleSource> source) {
    return Volume(grid, type, std::make_shared<const VolumeStore>(grid, type, std::move(source)));
}

namespace {

// Counts the channels and times of data, unless the reader has listed them by name.
void list_taken(const StoredData& data, VolumeContents& contents) {
    constexpr std::int64_t most_listed = 65536;  // a file of more is damaged, or not for people
    for (const StoredAxis& axis : data.axes) {
        if (!axis.taken || axis.size == 1 || axis.size > most_listed) continue;
        const bool is_channel = std::string_view(axis.what) == "channel";
        std::vector<std::string>& names = is_channel ? contents.channels : contents.times;
        if (names.empty()) names.resize(static_cast<std::size_t>(axis.size));
    }
}

}  // namespace

Volume open_stored(const Grid& grid, const StoredData& data, const VolumeUse& use) {
    const std::string name = data.path.string();
    const std::size_t bytes = stored_bytes(name, data.axes, bytes_of(data.type), true);
    if (use.contents != nullptr) list_taken(data, *use.contents);
    if (StreamSource::can_read(data) && use.residence == VolumeUse::Residence::in_order)
        return stored_volume(grid, *drawn_type(data.type),
                             std::make_unique<StreamSource>(data, grid.size));
    if (FileSource::can_read(data)) {
        const SampleType type = *drawn_type(data.type);
        if (stays_in_files(grid, type, use))
            return stored_volume(grid, type, std::make_unique<FileSource>(data, grid.size));
    } else {
        std::string why = "its data are not raw";
        if (data.encoding == DataEncoding::raw)
            why = data.is_scaled() ? "its samples are scaled"
                                   : fmt::format("its samples are of type {}", name_of(data.type));
        expect_room(name, bytes, use, why);
    }
    return drawn_volume(grid, read_stored(data), use.lookup);
}

}  // namespace lamina
