// SPDX-License-Identifier: Apache-2.0
#include "projection/part_outline.h"

#include <algorithm>
#include <cmath>

namespace lamina {
namespace {

// Of all pairs of a front and a back face, by the number of front faces.
using Faces = std::array<std::size_t, 4>;
constexpr std::array<Faces, 4> front_of{Faces{0, 0, 0, 0}, Faces{0, 0, 0, 0}, Faces{0, 1, 0, 1},
                                        Faces{0, 1, 2, 2}};
constexpr std::array<Faces, 4> back_of{Faces{0, 0, 0, 0}, Faces{1, 2, 3, 3}, Faces{2, 2, 3, 3},
                                       Faces{3, 3, 3, 3}};

// More than all roundings of depths and of the bounds, of depths and per pixel from the center:
// what the outline leaves out must not be seen.
constexpr float rounding = 1e-6f, least_slack = 1e-3f;

// Lines along rows are made a little oblique, so that they bound columns.
constexpr float oblique = 1e-4f;

}  // namespace

PartOutline outline_of(const TetRecord& record, const PixelArea& area, int image_rows) {
    constexpr float middle = 0.5f * (TileGrid::block - 1);
    const float columns = static_cast<float>(area.last_column - area.first_column),
                rows = static_cast<float>(area.last_row - area.first_row);
    const float column = static_cast<float>(area.first_column) + 0.5f - record.center[0] + middle,
                row = static_cast<float>(image_rows - area.first_row) - 0.5f - record.center[1] -
                      middle;
    const float slack =
        least_slack + rounding * (std::abs(column) + std::abs(row) + columns + rows + 64);
    const auto& [depth, depth_low] = record.depth;
    const auto& [per_column, column_low] = record.depth_per_column;
    const auto& [per_row, row_low] = record.depth_per_row;
    std::array<float, 4> slack_of_face;
    for (std::size_t i = 0; i < 4; ++i)
        slack_of_face[i] = slack * (std::abs(per_column[i]) + std::abs(per_row[i])) +
                           rounding * std::abs(depth[i]);
    const float extent = middle + oblique * (columns + 8);
    const Faces& fronts = front_of[record.fronts & 3u];
    const Faces& backs = back_of[record.fronts & 3u];
    std::array<float, 4> d, c, r, s;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t front = fronts[i], back = backs[i];
        d[i] = depth[back] - depth[front];
        c[i] = per_column[back] - per_column[front];
        r[i] = per_row[back] - per_row[front];
        s[i] = slack_of_face[back] + slack_of_face[front];
    }
    // The difference of depth at the corner of a square where it is largest is
    // most + c X - r Y, for the square X columns and Y rows from the area's first pixel.
    PartOutline outline;
    for (std::size_t i = 0; i < 4; ++i) {
        const float most = d[i] + c[i] * column + r[i] * row + middle * std::abs(c[i]) +
                           extent * std::abs(r[i]) + s[i];
        const float steepness =
            std::max(std::max(std::abs(c[i]), oblique * std::abs(r[i])), 1e-30f);
        const float divisor = std::copysign(steepness, c[i]);
        outline.at_first[i] = -most / divisor;
        outline.per_row[i] = r[i] / divisor;
    }
    for (unsigned i = 0; i < 4; ++i)
        outline.least |= static_cast<std::uint8_t>(std::signbit(c[i]) ? 0u : 1u << i);
    return outline;
}

}  // namespace lamina
