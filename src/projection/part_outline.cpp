// SPDX-License-Identifier: Apache-2.0
#include "projection/part_outline.h"

#include <hwy/highway.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace lamina {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// The front face and the back face of each pair of one of either kind, by the number of front
// faces.
alignas(16) constexpr std::int32_t front_of[4][4] = {
    {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 1}, {0, 1, 2, 2}};
alignas(16) constexpr std::int32_t back_of[4][4] = {
    {0, 0, 0, 0}, {1, 2, 3, 3}, {2, 2, 3, 3}, {3, 3, 3, 3}};

// These are more than all rounding errors of depths and of the bounds, in depth and per pixel from
// the center, because what the outline leaves out must not be seen.
constexpr float rounding = 1e-6f, least_slack = 1e-3f;

// Lines along rows are made a little oblique, so that they bound columns, too.
constexpr float oblique = 1e-4f;

}  // namespace

// The largest difference of depth at a corner of the square X columns and Y rows from the area's
// first pixel is most + c X - r Y. There is a lane for each line.
PartOutline outline_of(const TetRecord& record, const PixelArea& area, int image_rows) {
    constexpr float middle = 0.5f * (TileGrid::block - 1);
    const float columns = static_cast<float>(area.last_column - area.first_column),
                rows = static_cast<float>(area.last_row - area.first_row);
    const float column = static_cast<float>(area.first_column) + 0.5f - record.center[0] + middle,
                row = static_cast<float>(image_rows - area.first_row) - 0.5f - record.center[1] -
                      middle;
    const hn::FixedTag<float, 4> d;
    const hn::RebindToSigned<decltype(d)> di;
    const std::uint32_t fronts = record.fronts & 3u;
    const auto front = hn::IndicesFromVec(d, hn::Load(di, front_of[fronts])),
               back = hn::IndicesFromVec(d, hn::Load(di, back_of[fronts]));
    const auto depth = hn::Load(d, record.depth.high.data()),
               per_column = hn::Load(d, record.depth_per_column.high.data()),
               per_row = hn::Load(d, record.depth_per_row.high.data());
    const auto difference = [&](auto v) HWY_ATTR {
        return hn::Sub(hn::TableLookupLanes(v, back), hn::TableLookupLanes(v, front));
    };
    const auto times = [&](auto v, float factor)
                           HWY_ATTR { return hn::Mul(v, hn::Set(d, factor)); };
    const float slack =
        least_slack + rounding * (std::abs(column) + std::abs(row) + columns + rows + 64);
    const auto slack_of_face = hn::Add(times(hn::Add(hn::Abs(per_column), hn::Abs(per_row)), slack),
                                       times(hn::Abs(depth), rounding));
    const auto c = difference(per_column), r = difference(per_row);
    const auto abs_c = hn::Abs(c), abs_r = hn::Abs(r);
    const auto at_middle = hn::Add(hn::Add(difference(depth), times(c, column)), times(r, row));
    const auto to_corner =
        hn::Add(times(abs_c, middle), times(abs_r, middle + oblique * (columns + 8)));
    const auto most =
        hn::Add(hn::Add(at_middle, to_corner), hn::Add(hn::TableLookupLanes(slack_of_face, back),
                                                       hn::TableLookupLanes(slack_of_face, front)));
    const auto steepness = hn::Max(hn::Max(abs_c, times(abs_r, oblique)), hn::Set(d, 1e-30f));
    const auto is_least = hn::Ge(c, hn::Zero(d));
    const auto divisor = hn::IfThenElse(is_least, steepness, hn::Neg(steepness));
    PartOutline outline;
    hn::StoreU(hn::Div(hn::Neg(most), divisor), d, outline.at_first.data());
    hn::StoreU(hn::Div(r, divisor), d, outline.per_row.data());
    std::uint8_t bits[8];
    hn::StoreMaskBits(d, is_least, bits);
    outline.least = bits[0];
    return outline;
}

}  // namespace lamina
HWY_AFTER_NAMESPACE();
