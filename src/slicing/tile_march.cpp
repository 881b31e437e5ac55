// SPDX-License-Identifier: Apache-2.0
#include "slicing/tile_march.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "slicing/tile_march.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "slicing/tile_segments-inl.h"
#include "tiles/node_code-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

// Associated colour and optical depth of a part of a ray.
struct NodeSum {
    Floats color[3];
    Floats depth;
};

class Marcher {
  public:
    Marcher(const TileSlabs& slabs, const TreeShape& shape, int column, int row)
        : slabs_(slabs),
          plan_(*slabs.plan),
          shape_(shape),
          single_color_(plan_.single_color),
          column_(column),
          row_(row) {
        if (slabs_.bricks.size() == 1)
            rays_ = packet_rays(slabs_.rays, slabs_.bricks[0], column_, row_);
    }

    // What a node of the tree holds before it is written.
    NodeSum evaluate(int level, const SampleSpan& node) {
        if (is_marched(shape_, level, node)) return march(node);
        const FloatTag d;
        NodeSum sum{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Zero(d)};
        Floats transmittance = hn::Set(d, 1.0f);
        const int children = shape_.factor(level);
        for (int i = 0; i < children; ++i) {
            const SampleSpan child = child_span(node, i, children);
            if (child.count == 0) continue;
            const NodeSum image = stored(evaluate(level + 1, child), child.count);
            sum.depth = hn::Add(sum.depth, image.depth);
            const Floats weight = hn::Mul(transmittance, opacity_from_depth(d, image.depth));
            if (!single_color_) {
                for (int channel = 0; channel < 3; ++channel)
                    sum.color[channel] = mul_add(weight, image.color[channel], sum.color[channel]);
            }
            transmittance = hn::Sub(transmittance, weight);
        }
        return sum;
    }

    std::int64_t segments() const { return segments_; }

  private:
    // A child as its node reads it: colour not associated, rounded to the image's format.
    NodeSum stored(const NodeSum& child, int samples) const {
        const FloatTag d;
        const TreePlan& tree = *plan_.tree;
        const float share = static_cast<float>(samples) / static_cast<float>(shape_.samples());
        const bool fine_alpha = plan_.target == Target::fixed8 && tree.alpha_bits == 16;
        const Floats code = encode_depth(d, tree.code, child.depth, share);
        NodeSum image;
        image.depth = decode_depth(
            d, tree.code, in_format(fine_alpha ? Target::fixed16 : plan_.target, code), share);
        if (single_color_) return image;
        const Floats opacity = opacity_from_depth(d, child.depth);
        const Floats largest = hn::Set(d, static_cast<float>(tree.largest_color));
        const auto some = hn::Gt(opacity, hn::Zero(d));
        for (int channel = 0; channel < 3; ++channel) {
            const Floats color =
                hn::IfThenElseZero(some, hn::Div(child.color[channel], hn::Mul(opacity, largest)));
            image.color[channel] = hn::Mul(largest, in_format(plan_.target, color));
        }
        return image;
    }

    static Floats in_format(Target target, Floats value) {
        const FloatTag d;
        switch (target) {
            case Target::float32:
                return value;
            case Target::float16:
                return truncate_to_half(d, value);
            default:
                const float largest = target == Target::fixed16 ? 65535.0f : 255.0f;
                return hn::Div(native_code(d, largest, value), hn::Set(d, largest));
        }
    }

    // All slabs of a leaf. Sums of thousands of small terms: of a block in float, in which nothing
    // is lost as opacity begins at 0, of blocks in double.
    NodeSum march(const SampleSpan& leaf) {
        const FloatTag d;
        TwoDoubles color[3] = {all(0), all(0), all(0)}, depth = all(0), transmittance = all(1);
        for (const TileBrickView& brick : slabs_.bricks) {
            if (slabs_.bricks.size() > 1) rays_ = packet_rays(slabs_.rays, brick, column_, row_);
            set_span(slabs_.rays, brick, leaf.first, leaf.end(), rays_);
            for_each_block(leaf, [&] HWY_ATTR {
                segments_ += set_segments(slabs_, brick, rays_, !single_color_, block_);
                if (single_color_) {
                    add(depth, block_depth());
                } else {
                    add_block(color, depth, transmittance);
                }
            });
        }
        NodeSum sum{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, narrow(depth)};
        if (single_color_) return sum;
        for (int channel = 0; channel < 3; ++channel) sum.color[channel] = narrow(color[channel]);
        return sum;
    }

    // Blocks begin at the leaf's first slab, whatever part of them is wanted: pictures must not
    // depend on that.
    template <class Body>
    HWY_INLINE void for_each_block(const SampleSpan& leaf, const Body& body) {
        if (rays_.first_slab >= rays_.end_slab) return;
        const int number = (rays_.first_slab - leaf.first) / tile_block_slabs;
        block_.first_slab = leaf.first + number * tile_block_slabs;
        for (; block_.first_slab < rays_.end_slab; block_.first_slab += tile_block_slabs) {
            block_.from = std::max(rays_.first_slab - block_.first_slab, 0);
            block_.end = std::min(rays_.end_slab - block_.first_slab, tile_block_slabs);
            body();
        }
    }

    static HWY_INLINE void add(TwoDoubles& sum, Floats v) {
        const TwoDoubles wide = widen(v);
        for (int h = 0; h < 2; ++h) sum.half[h] = hn::Add(sum.half[h], wide.half[h]);
    }

    Floats block_depth() const {
        const FloatTag d;
        Floats depth = hn::Zero(d);
        for (int i = block_.from; i < block_.end; ++i)
            depth = hn::Add(depth, hn::Load(d, block_.depths + at(i)));
        return depth;
    }

    HWY_INLINE void add_block(TwoDoubles (&color)[3], TwoDoubles& depth,
                              TwoDoubles& transmittance) const {
        const FloatTag d;
        const DoubleTag dd;
        const Floats one = hn::Set(d, 1.0f);
        Floats red = hn::Zero(d), green = red, blue = red, opacity = red, sum = red;
        for (int i = block_.from; i < block_.end; ++i) {
            const Floats segment = hn::Load(d, block_.depths + at(i));
            const Floats weight = hn::Mul(hn::Sub(one, opacity), opacity_from_depth(d, segment));
            red = mul_add(weight, hn::Load(d, block_.colors[0] + at(i)), red);
            green = mul_add(weight, hn::Load(d, block_.colors[1] + at(i)), green);
            blue = mul_add(weight, hn::Load(d, block_.colors[2] + at(i)), blue);
            opacity = hn::Add(opacity, weight);
            sum = hn::Add(sum, segment);
        }
        const Floats parts[3] = {red, green, blue};
        for (int channel = 0; channel < 3; ++channel) {
            const TwoDoubles part = widen(parts[channel]);
            for (int h = 0; h < 2; ++h) {
                color[channel].half[h] =
                    mul_add(transmittance.half[h], part.half[h], color[channel].half[h]);
            }
        }
        const TwoDoubles hidden = widen(opacity);
        for (int h = 0; h < 2; ++h) {
            transmittance.half[h] =
                hn::Mul(transmittance.half[h], hn::Sub(hn::Set(dd, 1.0), hidden.half[h]));
        }
        add(depth, sum);
    }

    const TileSlabs& slabs_;
    const SlicePlan& plan_;
    const TreeShape& shape_;
    bool single_color_;
    int column_, row_;
    std::int64_t segments_ = 0;
    PacketRays rays_;
    SlabBlock block_;
};

std::int64_t march_pixels(const TileSlabs& slabs, const TreeShape& shape,
                          const TileGrid::Tile& area, TilePixels& pixels) {
    const FloatTag d;
    const Target target = slabs.plan->target;
    const bool codes = is_fixed_point(target);
    const float largest = codes ? static_cast<float>(largest_code(slabs.plan->code_bits())) : 1.0f;
    std::int64_t segments = 0;
    const auto store = [&](Floats value, TilePixels::Plane& plane, std::size_t place) HWY_ATTR {
        if (codes) value = native_code(d, largest, value);
        if (target == Target::float16) value = truncate_to_half(d, value);
        hn::Store(value, d, plane.data() + place);
    };
    for (std::size_t place = 0; place < TileGrid::pixels; place += hn::Lanes(d)) {
        const TileGrid::Place at = TileGrid::pixel_at(static_cast<int>(place));
        if (at.column >= area.width || at.row >= area.height) continue;
        Marcher marcher(slabs, shape, area.column + at.column, area.row + at.row);
        const NodeSum sum = marcher.evaluate(0, shape.root());
        segments += marcher.segments();
        const Floats opacity = opacity_from_depth(d, sum.depth);
        const bool single = slabs.plan->single_color;
        const auto color = [&](std::size_t channel) HWY_ATTR {
            return single ? hn::Mul(hn::Set(d, slabs.single_color[channel]), opacity)
                          : sum.color[channel];
        };
        store(color(0), pixels.red, place);
        store(color(1), pixels.green, place);
        store(color(2), pixels.blue, place);
        store(opacity, pixels.alpha, place);
    }
    return segments;
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(march_pixels);

std::int64_t march_tile(const TileSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area,
                        TilePixels& pixels) {
    return HWY_DYNAMIC_DISPATCH(march_pixels)(slabs, shape, area, pixels);
}

}  // namespace lamina
#endif
