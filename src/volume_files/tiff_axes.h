// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <string>

namespace lamina {

// What the pages of a TIFF stack mean, as ImageJ or OME wrote it into the first page's description.
struct TiffAxes {
    std::int64_t channels = 1, slices = 1, times = 1;
    // How far one page leads along each of these.
    std::int64_t channel_step = 1, slice_step = 1, time_step = 1;
    glm::dvec3 spacing{1, 1, 1};
};

// `pages`: how many there are; `resolution`: pixels a unit along x and y, 0 where it is not said.
// Pages of which the description tells nothing are slices, one apart. Resolutions without ImageJ's
// description are not trusted: programs write 72 dots an inch into everything, and know no distance
// between slices. Throws Error where the description has another number of pages.
TiffAxes tiff_axes(const std::string& file, const std::string& description, std::int64_t pages,
                   const std::array<double, 2>& resolution);

}  // namespace lamina
