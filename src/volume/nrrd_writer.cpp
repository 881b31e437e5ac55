// SPDX-License-Identifier: Apache-2.0
#include "volume/nrrd_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/coded_image.h"
#include "volume/labels.h"

namespace lamina {
namespace {

std::string vector_text(const glm::dvec3& vector) {
    return fmt::format("({},{},{})", vector.x, vector.y,
                       vector.z);  // shortest text that reads back as the same double
}

const char* centering_text(Centering centering) {
    return centering == Centering::cell ? "cell" : "node";
}

std::string axis_text(const Grid& grid) {
    // Only left-posterior-superior is named: readers of medical images flip the axes of other
    // spaces.
    if (grid.axes == WorldAxes::left_posterior_superior) return "space: left-posterior-superior\n";
    return "space dimension: 3\n";
}

// Returns the number that digits stand for; nothing if it is none of this type.
template <typename Number>
std::optional<Number> number_in(const std::string& digits) {
    Number number{};
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, number);
    if (error != std::errc{} || stop != end) return {};
    return number;
}

std::string header_text(const Grid& grid, const char* type, const std::string& sample_unit,
                        const NrrdTimes& times = {}) {
    const bool series = times.count > 1;
    std::string text = "NRRD0004\n";
    text += fmt::format("type: {}\n", type);
    text += fmt::format("dimension: {}\n{}", series ? 4 : 3, axis_text(grid));
    text += fmt::format("sizes: {} {} {}{}\n", grid.size[0], grid.size[1], grid.size[2],
                        series ? fmt::format(" {}", times.count) : "");
    text +=
        fmt::format("space directions: {} {} {}{}\n", vector_text(grid.step[0]),
                    vector_text(grid.step[1]), vector_text(grid.step[2]), series ? " none" : "");
    if (series) text += fmt::format("spacings: NaN NaN NaN {}\n", times.step);
    if (series && !times.unit.empty())
        text += fmt::format("units: \"\" \"\" \"\" \"{}\"\n", times.unit);
    if (!grid.unit.empty())
        text += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", grid.unit);
    text += fmt::format("centers: {} {} {}{}\n", centering_text(grid.centering[0]),
                        centering_text(grid.centering[1]), centering_text(grid.centering[2]),
                        series ? " ???" : "");
    text += fmt::format("kinds: domain domain domain{}\n", series ? " time" : "");
    if (!sample_unit.empty()) text += fmt::format("sample units: {}\n", one_line(sample_unit));
    text +=
        fmt::format("endian: {}\n", std::endian::native == std::endian::little ? "little" : "big");
    text += fmt::format("encoding: raw\nspace origin: {}\n", vector_text(grid.origin));
    return text;
}

// Largest header and line that are read (volume_files/nrrd.cpp), less what else is in them, in
// bytes.
constexpr std::size_t most_key_bytes = 1000000, most_name_bytes = 400;

// Returns the keys of 3D Slicer for the labels of which more is known than their numbers. Throws
// Error if a header cannot hold them.
std::string segment_keys(const VolumeLabels& labels) {
    std::string text;
    int count = 0;
    for (const Label& label : labels.list) {
        if (label.name.empty() && !label.color && label.opacity == 1) continue;
        if (label.name.size() > most_name_bytes) {
            fail("label {}: found a name of {} bytes, expected at most {} in a NRRD file",
                 label.number, label.name.size(), most_name_bytes);
        }
        const std::string key = fmt::format("Segment{}_", count++);
        text +=
            fmt::format("{0}ID:=Segment_{1}\n{0}LabelValue:={1}\n{0}Layer:=0\n", key, label.number);
        if (!label.name.empty()) text += fmt::format("{}Name:={}\n", key, one_line(label.name));
        if (label.opacity != 1) text += fmt::format("{}Opacity:={}\n", key, label.opacity);
        if (!label.color) continue;
        text += fmt::format("{}Color:={} {} {}\n", key, srgb_from_linear(label.color->r),
                            srgb_from_linear(label.color->g), srgb_from_linear(label.color->b));
    }
    if (text.size() > most_key_bytes) {
        fail("labels: found {} bytes of names and colours, expected at most {} in a NRRD file",
             text.size(), most_key_bytes);
    }
    return text;
}

// Writes the numbers that codes stand for.
template <typename Number>
void write_numbers(AtomicFile& file, const Volume& volume) {
    std::vector<Number> numbers;  // by code
    for (const Label& label : volume.labels()->list)
        numbers.push_back(number_in<Number>(label.number).value());
    constexpr std::int64_t samples_together = 1 << 16;
    std::vector<Number> part;
    const std::int64_t count = volume.grid().sample_count();
    volume.visit([&](const auto* codes) {
        for (std::int64_t begin = 0; begin < count; begin += samples_together) {
            part.clear();
            for (std::int64_t i = begin; i < std::min(count, begin + samples_together); ++i)
                part.push_back(numbers.at(static_cast<std::size_t>(codes[i])));
            file.write(part.data(), part.size() * sizeof(Number));
        }
    });
}

// Writes a volume whose labels are renumbered: in the first type that holds all numbers.
void write_labels(AtomicFile& file, const Volume& volume, const std::string& keys) {
    const std::vector<Label>& list = volume.labels()->list;  // in increasing order
    const auto written = [&]<typename Number>(Number /*zero*/, const char* type) {
        if (!number_in<Number>(list.front().number) || !number_in<Number>(list.back().number))
            return false;
        file.write(header_text(volume.grid(), type, volume.quantity().unit) + keys);
        write_numbers<Number>(file, volume);
        return true;
    };
    if (written(std::int32_t{}, "int32") || written(std::uint32_t{}, "uint32") ||
        written(std::int64_t{}, "int64") || written(std::uint64_t{}, "uint64"))
        return;
    fail("labels: found {} and {}, expected whole numbers of one type", list.front().number,
         list.back().number);
}

}  // namespace

void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type,
                       const NrrdTimes& times) {
    file.write(header_text(grid, name_of(type), "", times) + "\n");
}

void write_nrrd(AtomicFile& file, const Volume& volume) {
    // Readers take a volume with segments for labels, and one whose samples look like labels.
    const auto key = [](const char* lookup) {
        return fmt::format("{}:={}\n", nrrd_lookup_key, lookup);
    };
    std::string keys;
    if (volume.grid().lookup == VolumeLookup::nearest)
        keys = key("nearest") + (volume.labels() ? segment_keys(*volume.labels()) : "");
    else if (label_signs(volume).are_labels())
        keys = key("linear");
    keys += "\n";
    if (volume.labels() && volume.labels()->renumbered) return write_labels(file, volume, keys);
    file.write(header_text(volume.grid(), name_of(volume.type()), volume.quantity().unit) + keys);
    file.write(volume.data(), volume.byte_count());
}

}  // namespace lamina
