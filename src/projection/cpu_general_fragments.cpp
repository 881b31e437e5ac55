// SPDX-License-Identifier: Apache-2.0
// Draws all plans without a shader of their own: whole tets and cell fragments by GeneralShader,
// the triangles of Kraus 2004 by TriangleDrawing. For each triangle and vector of pixels:
//   1. Find the weights of its corners from its edge functions; they are 0 outside.
//   2. Interpolate scalars or optics at the ray's entry and exit, and the length between them.
//   3. Find the segment's colour and opacity, and composite them onto the tile.
#include "projection/cpu_fragments.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "projection/cpu_general_fragments.cpp"
#include "simd/foreach_target.h"

#include "projection/general_shading-inl.h"

LAMINA_SIMD_BEGIN

// The barycentric weights of a triangle's corners at some pixels; 0 for pixels not covered.
struct CornerWeights {
    Float corner[3];
    bool any = false;
};

// Returns the weights; `column`, `row`: window coordinates of pixel centres.
LAMINA_INLINE CornerWeights corner_weights_at(const TriangleRecord& triangle, Float column,
                                              Float row) {
    const Float64 columns(column), rows(row);
    const auto linear = [&](const auto& function) LAMINA_LAMBDA {
        return function.per_column * (columns - function.column) +
               function.per_row * (rows - function.row);
    };
    Float64Mask inside = columns == columns;
    for (const TriangleRecord::Edge& edge : triangle.edges) {
        const Float64 area = linear(edge);
        inside = inside & (edge.has_zeros ? area >= 0 : area > 0);
    }
    CornerWeights weights;
    Float sum(0);
    for (std::size_t i = 0; i < 3; ++i) {
        weights.corner[i] = to_float(zero_unless(inside, linear(triangle.shares[i])));
        sum += weights.corner[i];
    }
    weights.any = !all_of(sum == 0);
    return weights;
}

LAMINA_INLINE Float interpolate(const CornerWeights& weights, float a, float b, float c) {
    return weights.corner[0] * a + (weights.corner[1] * b + weights.corner[2] * c);
}

// Draws the triangles of Kraus 2004 on a tile, as shaders/projection/fan.glsl does.
class TriangleDrawing {
  public:
    TriangleDrawing(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile) {
        constexpr float width = TileGrid::block;
        const Float number = iota<Float>(0);
        lane_rows_ = floor(number / width);
        lane_columns_ = number - lane_rows_ * width;
    }

    void draw(const TriangleRecord& triangle, const CoveredArea& area) {
        const int rows_a_vector = static_cast<int>(Float::lanes) / TileGrid::block;
        const auto center = [](int pixel) { return static_cast<float>(pixel) + 0.5f; };
        const Centers pixels{center(area.first_column), center(area.last_column),
                             center(fragments_.image_rows - 1 - area.last_row),
                             center(fragments_.image_rows - 1 - area.first_row)};
        for_each_block(
            blocks_of(area, tile_.area), [&](int column, int row_of_block) LAMINA_LAMBDA {
                const Float columns = lane_columns_ + center(tile_.area.column + column);
                for (int step = 0; step < TileGrid::block; step += rows_a_vector) {
                    const int row = row_of_block + step;
                    const float first =
                        static_cast<float>(fragments_.image_rows - tile_.area.row - row) - 0.5f;
                    const Float rows = first - lane_rows_;
                    draw_at(triangle, pixels, columns, rows,
                            static_cast<std::size_t>(TileGrid::place(column, row)));
                }
            });
    }
    std::int64_t fragments() const { return count_; }

  private:
    // Window coordinates of the first and last pixel centres of an area.
    struct Centers {
        float left, right, lowest, highest;
    };
    LAMINA_INLINE void draw_at(const TriangleRecord& triangle, const Centers& pixels, Float columns,
                               Float rows, std::size_t place) {
        const CornerWeights weights = corner_weights_at(triangle, columns, rows);
        if (!weights.any) return;
        const Float sum = weights.corner[0] + (weights.corner[1] + weights.corner[2]);
        const FloatMask in_columns = (columns >= pixels.left) & (columns <= pixels.right);
        const FloatMask in_rows = (rows >= pixels.lowest) & (rows <= pixels.highest);
        const FloatMask covered = (sum > 0) & (in_columns & in_rows);
        count_ += static_cast<std::int64_t>(count_of(covered));
        const Fragment color = color_of(triangle, weights, place);
        const Fragment seen{zero_unless(covered, color.red), zero_unless(covered, color.green),
                            zero_unless(covered, color.blue), zero_unless(covered, color.alpha)};
        put_fragments(fragments_, triangle.number, seen, tile_, place);
    }

    LAMINA_INLINE Fragment color_of(const TriangleRecord& triangle, const CornerWeights& weights,
                                    std::size_t place) const {
        const auto& [a, b, c] = triangle.corners;
        const auto front = [&](int channel) LAMINA_LAMBDA {
            return interpolate(weights, a.front[channel], b.front[channel], c.front[channel]);
        };
        const auto back = [&](int channel) LAMINA_LAMBDA {
            return interpolate(weights, a.back[channel], b.back[channel], c.back[channel]);
        };
        if (fragments_.source == SegmentSource::vertices)
            return vertex_color(front(0), front(1), front(2), front(3));
        Float z_front(1), z_back(1);
        Float length = max(interpolate(weights, a.inverse.z, b.inverse.z, c.inverse.z), 0);
        if (fragments_.divided) {
            z_front = 1 / interpolate(weights, a.inverse.x, b.inverse.x, c.inverse.x);
            z_back = 1 / interpolate(weights, a.inverse.y, b.inverse.y, c.inverse.y);
            length = max(length * z_front * z_back, 0);
            if (tile_.slants != nullptr) length *= load<Float>(tile_.slants + place);
        }
        if (fragments_.opacity_only) length *= fragments_.depth_scale;
        if (fragments_.source != SegmentSource::mean) {
            const auto within = [&](Float scalar) LAMINA_LAMBDA {
                return min(max(triangle.scalars.x, scalar), triangle.scalars.y);
            };
            return segment_color(fragments_,
                                 {within(front(0) * z_front), within(back(0) * z_back), length});
        }
        const auto mean = [&](int channel) LAMINA_LAMBDA {
            return 0.5f * (front(channel) * z_front + back(channel) * z_back);
        };
        const Float opacity = opacity_from_depth(mean(3) * length);
        return {mean(0) * opacity, mean(1) * opacity, mean(2) * opacity, opacity};
    }

    LAMINA_INLINE Fragment vertex_color(Float red, Float green, Float blue, Float opacity) const {
        const Float alpha = clamp01(opacity);
        return {clamp01(red) * alpha, clamp01(green) * alpha, clamp01(blue) * alpha, alpha};
    }

    const TetFragments& fragments_;
    const TetTile& tile_;
    Float lane_columns_, lane_rows_;
    std::int64_t count_ = 0;
};

std::int64_t draw_fans(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile) {
    TriangleDrawing drawing(fragments, tile);
    batch.for_each_word(tile.number, [&](std::size_t first, std::uint64_t word) LAMINA_LAMBDA {
        for_each_member(first, word, [&](std::size_t number) LAMINA_LAMBDA {
            drawing.draw(batch.triangle(number), batch.area(number));
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

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(draw_any);

std::int64_t draw_general_tets(const TetFragments& fragments, const TileBatch& batch,
                               const TetTile& tile) {
    return LAMINA_DISPATCH(draw_any)(fragments, batch, tile);
}

}  // namespace lamina
#endif
