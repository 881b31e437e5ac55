// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "slicing/tile_march.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "slicing/tile_blend.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/interrupt.h"
#include "slicing/tile_exact-inl.h"
#include "slicing/tile_precise-inl.h"
#include "slicing/tile_segments-inl.h"
#include "tiles/lane_pixels-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {

using Pixel = Pixels<Floats>;

// Composites slabs onto a vector of pixels, twin of shaders/slicing/slab.frag.
class SlabBlender {
  public:
    SlabBlender(const TileSlabs& slabs, const TargetBlend& target, const SampleSpan& span,
                double depth_scale, bool opacity_only)
        : slabs_(slabs),
          plan_(*slabs.plan),
          target_(target),
          span_(span),
          depth_scale_(depth_scale),
          opacity_only_(opacity_only),
          behind_(target.order == Order::front_to_back),
          as_codes_(plan_.emulation || plan_.dither),
          cells_(slabs, !plan_.single_color && !opacity_only) {
        const FloatTag d;
        if (!plan_.single_color || opacity_only_) return;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Floats color = hn::Set(d, slabs.single_color[channel]);
            for (int i = 0; i < tile_block_slabs; ++i)
                hn::Store(color, d, block_.colors[channel] + at(i));
        }
    }

    // `pixels`: of the group's packets; opacity_only: their alpha.
    void composite(const TileGrid::Tile& area, std::size_t group, Pixel* pixels) {
        for (const TileBrickView& brick : slabs_.bricks) {
            rays_.set_pixels(slabs_.rays, brick, area, group);
            rays_.set_slabs(slabs_, span_.first, span_.end());
            if (rays_.first_slab >= rays_.end_slab) continue;
            const int first = (rays_.first_slab - span_.first) / tile_block_slabs;
            const int last = (rays_.end_slab - 1 - span_.first) / tile_block_slabs;
            for (int k = 0; k <= last - first; ++k) {
                const int number = behind_ ? first + k : last - k;
                block_.first_slab = span_.first + number * tile_block_slabs;
                for (std::size_t p = 0; p < group_packets; ++p) {
                    block_.wanted = rays_.wanted(slabs_, p, number);
                    if (block_.wanted == 0) continue;
                    const TileGrid::Place at =
                        TileGrid::pixel_at(static_cast<int>(packet_place(group, p)));
                    column_ = area.column + at.column;
                    row_ = area.row + at.row;
                    composite_packet(brick, rays_.packets[p], pixels[p]);
                }
            }
        }
    }

    std::int64_t segments() const { return segments_; }

  private:
    HWY_INLINE void composite_packet(const TileBrickView& brick, const PacketRays& rays,
                                     Pixel& pixel) {
        const bool colored = !plan_.single_color && !opacity_only_;
        if (plan_.integrates_cells()) {
            segments_ += set_exact_segments(brick, rays, colored, cells_, block_);
            if (as_codes_) set_precise_depths(block_);
        } else {
            segments_ += as_codes_ ? set_precise_segments(slabs_, brick, rays, colored, block_)
                                   : set_segments(slabs_, brick, rays, colored, block_);
        }
        composite_block(pixel);
    }

    // Works on a copy, which stays in registers.
    void composite_block(Pixel& pixel) const {
        Pixel there = pixel;
        if (as_codes_) {
            for_each_slab([&](int i) HWY_ATTR { blend_code(i, there); });
        } else if (opacity_only_) {
            for_each_slab([&](int i) HWY_ATTR { blend_opacity_alone(i, there); });
        } else if (target_.target != Target::float32) {
            for_each_slab([&](int i) HWY_ATTR {
                blend(FloatTag(), target_, fragment(i, opacity_of(i)), there);
            });
        } else if (behind_) {
            for_each_slab([&](int i) HWY_ATTR { blend_float<true>(i, there); });
        } else {
            for_each_slab([&](int i) HWY_ATTR { blend_float<false>(i, there); });
        }
        pixel = there;
    }

    template <class Body>
    HWY_INLINE void for_each_slab(const Body& body) const {
        if (behind_) {
            for_each_run(block_.wanted, [&](int first, int end) HWY_ATTR {
                for (int i = first; i < end; ++i) body(i);
            });
        } else {
            for_each_run_backwards(block_.wanted, [&](int first, int end) HWY_ATTR {
                for (int i = end; i-- > first;) body(i);
            });
        }
    }

    HWY_INLINE Floats opacity_of(int slab) const {
        return opacity_from_depth(FloatTag(), hn::Load(FloatTag(), block_.depths + at(slab)));
    }

    HWY_INLINE Floats color_of(int slab, std::size_t channel) const {
        return hn::Load(FloatTag(), block_.colors[channel] + at(slab));
    }

    HWY_INLINE Fragment<Floats> fragment(int slab, Floats opacity) const {
        return {hn::Mul(color_of(slab, 0), opacity), hn::Mul(color_of(slab, 1), opacity),
                hn::Mul(color_of(slab, 2), opacity), opacity};
    }

    // blend() of tiles/target_pixels-inl.h with what it would ask known.
    template <bool behind>
    HWY_INLINE void blend_float(int slab, Pixel& there) const {
        const Fragment<Floats> source = fragment(slab, opacity_of(slab));
        const Floats kept = hn::Sub(hn::Set(FloatTag(), 1.0f), behind ? there.alpha : source.alpha);
        const auto put = [&](Floats color, Floats& pixel) HWY_ATTR {
            pixel = behind ? mul_add(color, kept, pixel) : mul_add(pixel, kept, color);
        };
        put(source.red, there.red);
        put(source.green, there.green);
        put(source.blue, there.blue);
        put(source.alpha, there.alpha);
    }

    HWY_INLINE void blend_opacity_alone(int slab, Pixel& there) const {
        const FloatTag d;
        const Floats depth = hn::Mul(hn::Load(d, block_.depths + at(slab)),
                                     hn::Set(d, static_cast<float>(depth_scale_)));
        blend_opacity(d, target_, opacity_from_depth(d, depth), there.alpha);
    }

    void blend_code(int slab, Pixel& there) const {
        const FloatTag d;
        const Floats alpha = code_of_alpha(slab);
        if (plan_.emulation && opacity_only_) {
            composite_opacity(d, target_, alpha, there.alpha);
        } else if (plan_.emulation) {
            composite_codes(
                d, target_,
                {code_of_color(slab, 0), code_of_color(slab, 1), code_of_color(slab, 2), alpha},
                there);
        } else if (opacity_only_) {
            blend_opacity(d, target_, hn::Div(alpha, hn::Set(d, target_.largest)), there.alpha);
        } else {
            const Floats largest = hn::Set(d, target_.largest);
            const Floats rounded = hn::Div(alpha, largest);
            const auto associated = [&](std::size_t channel) HWY_ATTR {
                const Floats color = plan_.dither->color
                                         ? hn::Div(code_of_color(slab, channel), largest)
                                         : color_of(slab, channel);
                return hn::Mul(color, rounded);
            };
            blend(d, target_, {associated(0), associated(1), associated(2), rounded}, there);
        }
    }

    Floats code_of_alpha(int slab) const {
        const FloatTag d;
        const DoubleTag dd;
        const auto scale = hn::Set(dd, depth_scale_);
        const auto opacity_of_depth = [&](HalfDoubles depth) HWY_ATTR {
            return opacity_from_depth(dd, hn::Mul(depth, scale));
        };
        const TwoDoubles opacity =
            each_half<FloatTag>(opacity_of_depth, load_doubles(block_.precise_depths + at(slab)));
        const int number = block_.first_slab + slab;
        if (plan_.dither) {
            const int place = number % plan_.dither->period;
            return dithered_code(d, target_, opacity, *plan_.dither,
                                 slabs_.alpha_ranks[static_cast<std::size_t>(place)]);
        }
        return alpha_code(d, target_, opacity, random_of(number));
    }

    Words random_of(int number) const {
        const WordTag d;
        if (target_.alpha_rounding != AlphaRounding::stochastic) return hn::Zero(d);
        return random_of_pixels(d, column_, row_, static_cast<std::uint32_t>(number), target_.seed);
    }

    Floats code_of_color(int slab, std::size_t channel) const {
        const FloatTag d;
        const Floats color = color_of(slab, channel);
        if (!plan_.dither || !plan_.dither->color) return color_code(d, target_, color);
        const int place = (block_.first_slab + slab) % plan_.dither->period;
        return dithered_code(d, target_, to_doubles(d, clamp01(d, color)), *plan_.dither,
                             slabs_.color_ranks[static_cast<std::size_t>(place)]);
    }

    const TileSlabs& slabs_;
    const SlicePlan& plan_;
    const TargetBlend& target_;
    SampleSpan span_;
    double depth_scale_;
    bool opacity_only_, behind_, as_codes_;
    int column_ = 0, row_ = 0;
    std::int64_t segments_ = 0;
    GroupRays rays_;
    SlabBlock block_;
    CellIntegrator cells_;
};

std::int64_t blend_pixels(const TileSlabs& slabs, const TargetBlend& target,
                          const TileGrid::Tile& area, TilePixels& pixels) {
    const FloatTag d;
    SlabBlender blender(slabs, target, {0, slabs.plan->slabs}, 1, false);
    for (std::size_t group = 0; group < tile_groups; ++group) {
        check_interrupt();
        Pixel there[group_packets];
        for (Pixel& pixel : there) pixel = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        blender.composite(area, group, there);
        for (std::size_t p = 0; p < group_packets; ++p) {
            const std::size_t place = packet_place(group, p);
            hn::Store(there[p].red, d, pixels.red.data() + place);
            hn::Store(there[p].green, d, pixels.green.data() + place);
            hn::Store(there[p].blue, d, pixels.blue.data() + place);
            hn::Store(there[p].alpha, d, pixels.alpha.data() + place);
        }
    }
    return blender.segments();
}

std::int64_t blend_opacities(const TileSlabs& slabs, const TargetBlend& target,
                             const TileGrid::Tile& area, const SampleSpan& span, double depth_scale,
                             TilePixels::Plane& opacity) {
    const FloatTag d;
    SlabBlender blender(slabs, target, span, depth_scale, true);
    for (std::size_t group = 0; group < tile_groups; ++group) {
        Pixel there[group_packets];
        for (std::size_t p = 0; p < group_packets; ++p)
            there[p].alpha = hn::Load(d, opacity.data() + packet_place(group, p));
        blender.composite(area, group, there);
        for (std::size_t p = 0; p < group_packets; ++p)
            hn::Store(there[p].alpha, d, opacity.data() + packet_place(group, p));
    }
    return blender.segments();
}

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lamina {

HWY_EXPORT(blend_pixels);
HWY_EXPORT(blend_opacities);

std::int64_t blend_tile(const TileSlabs& slabs, const TargetBlend& blend,
                        const TileGrid::Tile& area, TilePixels& pixels) {
    return HWY_DYNAMIC_DISPATCH(blend_pixels)(slabs, blend, area, pixels);
}

std::int64_t blend_tile_opacity(const TileSlabs& slabs, const TargetBlend& blend,
                                const TileGrid::Tile& area, const SampleSpan& span,
                                double depth_scale, TilePixels::Plane& opacity) {
    return HWY_DYNAMIC_DISPATCH(blend_opacities)(slabs, blend, area, span, depth_scale, opacity);
}

}  // namespace lamina
#endif
