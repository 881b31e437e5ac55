// SPDX-License-Identifier: Apache-2.0
#include "projection/tile_fragments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/tile_general_fragments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/general_shading-inl.h"
#include "projection/triangle_coverage-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Draws pixels of the paper's triangles, as shaders/projection/fan.glsl does.
class TriangleDrawing {
  public:
    TriangleDrawing(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile) {
        const Vector number = hn::Iota(d_, 0.0f),
                     width = hn::Set(d_, static_cast<float>(TileGrid::block));
        lane_rows_ = hn::Floor(hn::Div(number, width));
        lane_columns_ = hn::Sub(number, hn::Mul(lane_rows_, width));
    }

    void draw(const TriangleRecord& triangle, const PartArea& area) {
        const int rows_a_vector = static_cast<int>(hn::Lanes(d_)) / TileGrid::block;
        const auto center = [&](int pixel)
                                HWY_ATTR { return hn::Set(d_, static_cast<float>(pixel) + 0.5f); };
        const Centers pixels{center(area.first_column), center(area.last_column),
                             center(fragments_.image_rows - 1 - area.last_row),
                             center(fragments_.image_rows - 1 - area.first_row)};
        for_each_block(blocks_of(area, tile_.area), [&](int column, int row_of_block) HWY_ATTR {
            const Vector columns = hn::Add(
                lane_columns_, hn::Set(d_, static_cast<float>(tile_.area.column + column) + 0.5f));
            for (int step = 0; step < TileGrid::block; step += rows_a_vector) {
                const int row = row_of_block + step;
                const float first =
                    static_cast<float>(fragments_.image_rows - tile_.area.row - row) - 0.5f;
                const Vector rows = hn::Sub(hn::Set(d_, first), lane_rows_);
                draw_at(triangle, pixels, columns, rows,
                        static_cast<std::size_t>(TileGrid::place(column, row)));
            }
        });
    }
    std::int64_t fragments() const { return count_; }

  private:
    // Window coordinates of the first and last pixel centres of an area.
    struct Centers {
        Vector left, right, lowest, highest;
    };
    HWY_INLINE void draw_at(const TriangleRecord& triangle, const Centers& pixels, Vector columns,
                            Vector rows, std::size_t place) {
        const auto weights = corner_weights_at(d_, triangle, columns, rows);
        if (!weights.any) return;
        const auto sum = hn::Add(weights.corner[0], hn::Add(weights.corner[1], weights.corner[2]));
        const auto in_columns =
            hn::And(hn::Ge(columns, pixels.left), hn::Le(columns, pixels.right));
        const auto in_rows = hn::And(hn::Ge(rows, pixels.lowest), hn::Le(rows, pixels.highest));
        const auto covered = hn::And(hn::Gt(sum, hn::Zero(d_)), hn::And(in_columns, in_rows));
        count_ += static_cast<std::int64_t>(hn::CountTrue(d_, covered));
        const Fragment<Vector> color = color_of(triangle, weights, place);
        const Fragment<Vector> seen{
            hn::IfThenElseZero(covered, color.red), hn::IfThenElseZero(covered, color.green),
            hn::IfThenElseZero(covered, color.blue), hn::IfThenElseZero(covered, color.alpha)};
        put_fragments(d_, fragments_, triangle.number, seen, tile_, place);
    }

    HWY_INLINE Fragment<Vector> color_of(const TriangleRecord& triangle,
                                         const CornerWeights<Vector>& weights,
                                         std::size_t place) const {
        const auto& [a, b, c] = triangle.corners;
        const auto front = [&](int channel) HWY_ATTR {
            return interpolate(d_, weights, a.front[channel], b.front[channel], c.front[channel]);
        };
        const auto back = [&](int channel) HWY_ATTR {
            return interpolate(d_, weights, a.back[channel], b.back[channel], c.back[channel]);
        };
        if (fragments_.source == SegmentSource::vertices)
            return vertex_color(front(0), front(1), front(2), front(3));
        Vector z_front = hn::Set(d_, 1.0f), z_back = z_front;
        Vector length =
            hn::Max(interpolate(d_, weights, a.inverse.z, b.inverse.z, c.inverse.z), hn::Zero(d_));
        if (fragments_.divided) {
            const Vector one = hn::Set(d_, 1.0f);
            z_front = hn::Div(one, interpolate(d_, weights, a.inverse.x, b.inverse.x, c.inverse.x));
            z_back = hn::Div(one, interpolate(d_, weights, a.inverse.y, b.inverse.y, c.inverse.y));
            length = hn::Max(hn::Mul(hn::Mul(length, z_front), z_back), hn::Zero(d_));
            if (tile_.slants != nullptr)
                length = hn::Mul(length, hn::Load(d_, tile_.slants + place));
        }
        if (fragments_.opacity_only) length = hn::Mul(length, hn::Set(d_, fragments_.depth_scale));
        if (fragments_.source != SegmentSource::mean) {
            const auto within = [&](Vector scalar) HWY_ATTR {
                return hn::Clamp(scalar, hn::Set(d_, triangle.scalars.x),
                                 hn::Set(d_, triangle.scalars.y));
            };
            return segment_color(
                d_, fragments_,
                {within(hn::Mul(front(0), z_front)), within(hn::Mul(back(0), z_back)), length});
        }
        const auto mean = [&](int channel) HWY_ATTR {
            return hn::Mul(hn::Set(d_, 0.5f), hn::Add(hn::Mul(front(channel), z_front),
                                                      hn::Mul(back(channel), z_back)));
        };
        const Vector opacity = opacity_from_depth(d_, hn::Mul(mean(3), length));
        return {hn::Mul(mean(0), opacity), hn::Mul(mean(1), opacity), hn::Mul(mean(2), opacity),
                opacity};
    }

    HWY_INLINE Fragment<Vector> vertex_color(Vector red, Vector green, Vector blue,
                                             Vector opacity) const {
        const Vector alpha = clamp01(d_, opacity);
        return {hn::Mul(clamp01(d_, red), alpha), hn::Mul(clamp01(d_, green), alpha),
                hn::Mul(clamp01(d_, blue), alpha), alpha};
    }

    const TetFragments& fragments_;
    const TetTile& tile_;
    Tag d_;
    Vector lane_columns_, lane_rows_;
    std::int64_t count_ = 0;
};

std::int64_t draw_fans(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    TriangleDrawing drawing(fragments, tile);
    batch.for_each_word(tile.number, [&](std::size_t first, std::uint64_t parts) HWY_ATTR {
        for_each_member(first, parts, [&](std::size_t part) HWY_ATTR {
            drawing.draw(batch.triangle(part), batch.area(part));
        });
    });
    return drawing.fragments();
}

std::int64_t draw_any(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    if (batch.has_triangles()) return draw_fans(fragments, batch, tile);
    TetDrawing drawing(fragments, batch, tile);
    drawing.draw(GeneralShader(fragments));
    return drawing.fragments();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(draw_any);

std::int64_t draw_general_tets(const TetFragments& fragments, const TileBatch& batch,
                               const TetTile& tile) {
    return HWY_DYNAMIC_DISPATCH(draw_any)(fragments, batch, tile);
}

}  // namespace lamina
#endif
