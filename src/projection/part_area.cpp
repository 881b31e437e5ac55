// SPDX-License-Identifier: Apache-2.0
#include "projection/part_area.h"

#include <cmath>

#include "simd/vectors-inl.h"

LAMINA_SIMD_BEGIN
namespace {

// The front face and the back face of each pair of one of either kind, by the number of front
// faces.
alignas(16) constexpr std::int32_t front_of[4][4] = {
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 1}, {0, 1, 2, 2}};
alignas(16) constexpr std::int32_t back_of[4][4] = {
    {0, 0, 0, 0}, {1, 2, 3, 3}, {2, 2, 3, 3}, {3, 3, 3, 3}};

// These exceed all rounding errors of depths and of the bounds, in depth and per pixel from the
// center, because parts that the outline leaves out must not be visible.
constexpr float rounding = 1e-6f, least_slack = 1e-3f;

// Lines along rows are made a little oblique, so that they bound columns, too.
constexpr float oblique = 1e-4f;

}  // namespace

// The largest difference of depth at a corner of the square X columns and Y rows from the area's
// first pixel is most + c X - r Y. There is a lane for each line.
PartOutline find_outline(const SilhouetteRecord& record, const PixelArea& area, int image_rows) {
    constexpr float middle = 0.5f * (TileGrid::block - 1);
    const SeenTet& seen = record.seen();
    const float columns = static_cast<float>(area.last_column - area.first_column),
                rows = static_cast<float>(area.last_row - area.first_row);
    const float column = static_cast<float>(area.first_column) + 0.5f - seen.center[0] + middle,
                row = static_cast<float>(image_rows - area.first_row) - 0.5f - seen.center[1] -
                      middle;
    const std::uint32_t fronts = record.front_faces() & 3u;
    const Int4 front = load<Int4>(front_of[fronts]), back = load<Int4>(back_of[fronts]);
    const Float4 depth = load<Float4>(seen.depth.high.data()),
                 per_column = load<Float4>(seen.depth_per_column.high.data()),
                 per_row = load<Float4>(seen.depth_per_row.high.data());
    const auto difference = [&](Float4 v)
                                LAMINA_LAMBDA { return permute(v, back) - permute(v, front); };
    const float slack =
        least_slack + rounding * (std::abs(column) + std::abs(row) + columns + rows + 64);
    const Float4 slack_of_face = (abs(per_column) + abs(per_row)) * slack + abs(depth) * rounding;
    const Float4 c = difference(per_column), r = difference(per_row);
    const Float4 abs_c = abs(c), abs_r = abs(r);
    const Float4 at_middle = difference(depth) + c * column + r * row;
    const Float4 to_corner = abs_c * middle + abs_r * (middle + oblique * (columns + 8));
    const Float4 most =
        at_middle + to_corner + (permute(slack_of_face, back) + permute(slack_of_face, front));
    const Float4 steepness = max(max(abs_c, abs_r * oblique), 1e-30f);
    const auto is_least = c >= 0;
    const Float4 divisor = select(is_least, steepness, -steepness);
    PartOutline outline;
    store_unaligned(-most / divisor, outline.at_first.data());
    store_unaligned(r / divisor, outline.per_row.data());
    outline.least = static_cast<std::uint8_t>(bits_of(is_least));
    return outline;
}

LAMINA_SIMD_END

namespace lamina {

PartOutline outline_of(const SilhouetteRecord& record, const PixelArea& area, int image_rows) {
    return LAMINA_LEAST(find_outline)(record, area, image_rows);
}

}  // namespace lamina
