// SPDX-License-Identifier: Apache-2.0
#include "volume/nrrd_writer.h"

#include <fmt/format.h>

#include <bit>
#include <string>

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

// Returns the pairs in which 3D Slicer keeps a segmentation.
std::string segments_text(const std::vector<NrrdSegment>& segments) {
    std::string text;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const NrrdSegment& segment = segments[i];
        const std::string key = fmt::format("Segment{}_", i);
        text += fmt::format("{}ID:=Segment_{}\n", key, segment.value);
        text += fmt::format("{}Name:={}\n", key, segment.name);
        text += fmt::format("{}Color:={} {} {}\n", key, segment.color[0], segment.color[1],
                            segment.color[2]);
        text += fmt::format("{}LabelValue:={}\n{}Layer:=0\n", key, segment.value, key);
    }
    return text;
}

}  // namespace

void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type,
                       const NrrdExtras& extras) {
    const bool series = extras.times > 1;
    std::string text = "NRRD0004\n";
    text += fmt::format("type: {}\n", name_of(type));
    text += fmt::format("dimension: {}\n{}", series ? 4 : 3, axis_text(grid));
    text += fmt::format("sizes: {} {} {}{}\n", grid.size[0], grid.size[1], grid.size[2],
                        series ? fmt::format(" {}", extras.times) : "");
    text +=
        fmt::format("space directions: {} {} {}{}\n", vector_text(grid.step[0]),
                    vector_text(grid.step[1]), vector_text(grid.step[2]), series ? " none" : "");
    if (series) text += fmt::format("spacings: NaN NaN NaN {}\n", extras.time_step);
    if (series && !extras.time_unit.empty())
        text += fmt::format("units: \"\" \"\" \"\" \"{}\"\n", extras.time_unit);
    if (!grid.unit.empty())
        text += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", grid.unit);
    text += fmt::format("centers: {} {} {}{}\n", centering_text(grid.centering[0]),
                        centering_text(grid.centering[1]), centering_text(grid.centering[2]),
                        series ? " ???" : "");
    text += fmt::format("kinds: domain domain domain{}\n", series ? " time" : "");
    if (!extras.sample_unit.empty()) text += fmt::format("sample units: {}\n", extras.sample_unit);
    text +=
        fmt::format("endian: {}\n", std::endian::native == std::endian::little ? "little" : "big");
    text += fmt::format("encoding: raw\nspace origin: {}\n", vector_text(grid.origin));
    file.write(text + segments_text(extras.segments) + "\n");
}

void write_nrrd(AtomicFile& file, const Volume& volume) {
    write_nrrd_header(file, volume.grid(), volume.type());
    file.write(volume.data(), volume.byte_count());
}

}  // namespace lamina
