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

}  // namespace

void write_nrrd_header(AtomicFile& file, const Grid& grid, SampleType type) {
    std::string text = "NRRD0004\n";
    text += fmt::format("type: {}\n", name_of(type));
    // No space is named, because readers of medical images flip the axes of some spaces.
    text += "dimension: 3\nspace dimension: 3\n";
    text += fmt::format("sizes: {} {} {}\n", grid.size[0], grid.size[1], grid.size[2]);
    text += fmt::format("space directions: {} {} {}\n", vector_text(grid.step[0]),
                        vector_text(grid.step[1]), vector_text(grid.step[2]));
    if (!grid.unit.empty())
        text += fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", grid.unit);
    text += fmt::format("centers: {} {} {}\n", centering_text(grid.centering[0]),
                        centering_text(grid.centering[1]), centering_text(grid.centering[2]));
    text += "kinds: domain domain domain\n";
    text +=
        fmt::format("endian: {}\n", std::endian::native == std::endian::little ? "little" : "big");
    text += fmt::format("encoding: raw\nspace origin: {}\n\n", vector_text(grid.origin));
    file.write(text);
}

void write_nrrd(AtomicFile& file, const Volume& volume) {
    write_nrrd_header(file, volume.grid(), volume.type());
    file.write(volume.data(), volume.byte_count());
}

}  // namespace lamina
