// SPDX-License-Identifier: Apache-2.0

#include "slicing/cpu_slabs.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "slicing/cpu_blend.cpp"
#include "simd/foreach_target.h"

#include "base/client.h"
#include "slicing/cpu_cells-inl.h"
#include "slicing/cpu_slab_block-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// Composites slabs onto the pixels of a group of packets, as shaders/slicing/slab.frag does:
//   for each brick, each block of slabs in the plan's order, and each packet:
//       compute the optical depths and colours of the slabs that may be visible
//       for each of these slabs: composite it onto the pixels, rounded as the target needs
// `depth_scale` multiplies optical depths; `span`: the slabs; `opacity_only`: alpha alone is drawn.
class SlabBlender {
  public:
    SlabBlender(const CpuSlabs& slabs, const TargetBlend& target, const SampleSpan& span,
                double depth_scale, bool opacity_only)
        : slabs_(slabs),
          plan_(*slabs.plan),
          target_(target),
          span_(span),
          depth_scale_(depth_scale),
          opacity_only_(opacity_only),
          behind_(target.order == Order::front_to_back),
          as_codes_(plan_.emulation || plan_.dither),
          colored_(!plan_.single_color && !opacity_only),
          cells_(cell_integrator(slabs, colored_)) {
        if (!plan_.single_color || opacity_only_) return;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const Float color(slabs.single_color[channel]);
            for (int i = 0; i < block_slabs; ++i) store(color, block_.colors[channel] + at(i));
        }
    }

    void composite(const TileGrid::Tile& area, std::size_t group, Pixels* pixels) {
        for (const CpuBrickView& brick : slabs_.bricks) {
            rays_.set_pixels(slabs_.rays, brick, area, group);
            rays_.set_slabs(slabs_, span_.first, span_.end());
            if (rays_.first_slab >= rays_.end_slab) continue;
            const int first = (rays_.first_slab - span_.first) / block_slabs;
            const int last = (rays_.end_slab - 1 - span_.first) / block_slabs;
            for (int k = 0; k <= last - first; ++k) {
                const int number = behind_ ? first + k : last - k;
                block_.first_slab = span_.first + number * block_slabs;
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
    LAMINA_INLINE void composite_packet(const CpuBrickView& brick, const PacketRays& rays,
                                        Pixels& pixel) {
        if (plan_.integrates_cells()) {
            std::visit(
                [&](auto& cells) LAMINA_LAMBDA {
                    segments_ += set_exact_segments(brick, rays, colored_, cells, block_);
                },
                cells_);
            if (as_codes_) set_precise_depths(block_);
        } else {
            segments_ += set_segments(slabs_, brick, rays, colored_, as_codes_, block_);
        }
        composite_block(pixel);
    }

    // Composites the wanted slabs of a block. The copy of the pixel stays in registers.
    void composite_block(Pixels& pixel) const {
        Pixels there = pixel;
        if (as_codes_) {
            for_each_slab([&](int i) LAMINA_LAMBDA { blend_code(i, there); });
        } else if (opacity_only_) {
            for_each_slab([&](int i) LAMINA_LAMBDA { blend_opacity_alone(i, there); });
        } else if (target_.target != Target::float32) {
            for_each_slab([&](int i)
                              LAMINA_LAMBDA { blend(target_, fragment(i, opacity_of(i)), there); });
        } else if (behind_) {
            for_each_slab([&](int i) LAMINA_LAMBDA { blend_float<true>(i, there); });
        } else {
            for_each_slab([&](int i) LAMINA_LAMBDA { blend_float<false>(i, there); });
        }
        pixel = there;
    }

    // Calls body(slab) for the wanted slabs of the block in the plan's order.
    template <class Body>
    LAMINA_INLINE void for_each_slab(const Body& body) const {
        if (behind_) {
            for_each_range(block_.wanted, [&](int first, int end) LAMINA_LAMBDA {
                for (int i = first; i < end; ++i) body(i);
            });
        } else {
            for_each_range_backwards(block_.wanted, [&](int first, int end) LAMINA_LAMBDA {
                for (int i = end; i-- > first;) body(i);
            });
        }
    }

    LAMINA_INLINE Float opacity_of(int slab) const {
        return opacity_from_depth(load<Float>(block_.depths + at(slab)));
    }

    LAMINA_INLINE Float color_of(int slab, std::size_t channel) const {
        return load<Float>(block_.colors[channel] + at(slab));
    }

    LAMINA_INLINE Fragment fragment(int slab, Float opacity) const {
        return {color_of(slab, 0) * opacity, color_of(slab, 1) * opacity,
                color_of(slab, 2) * opacity, opacity};
    }

    // Does what blend() (tiles/target_pixels-inl.h) does for float32 targets, without its branches.
    template <bool behind>
    LAMINA_INLINE void blend_float(int slab, Pixels& there) const {
        const Fragment source = fragment(slab, opacity_of(slab));
        const Float kept = 1.0f - (behind ? there.alpha : source.alpha);
        const auto put = [&](Float color, Float& pixel) LAMINA_LAMBDA {
            pixel = behind ? color * kept + pixel : pixel * kept + color;
        };
        put(source.red, there.red);
        put(source.green, there.green);
        put(source.blue, there.blue);
        put(source.alpha, there.alpha);
    }

    LAMINA_INLINE void blend_opacity_alone(int slab, Pixels& there) const {
        const Float depth =
            load<Float>(block_.depths + at(slab)) * static_cast<float>(depth_scale_);
        blend_opacity(target_, opacity_from_depth(depth), there.alpha);
    }

    // Composites a slab whose opacity is rounded to a code, as render.emulate or dithering asks.
    void blend_code(int slab, Pixels& there) const {
        const Float alpha = code_of_alpha(slab);
        if (plan_.emulation && opacity_only_) {
            composite_opacity(target_, alpha, there.alpha);
        } else if (plan_.emulation) {
            composite_codes(
                target_,
                {code_of_color(slab, 0), code_of_color(slab, 1), code_of_color(slab, 2), alpha},
                there);
        } else if (opacity_only_) {
            blend_opacity(target_, alpha / target_.largest, there.alpha);
        } else {
            const float largest = target_.largest;
            const Float rounded = alpha / largest;
            const auto associated = [&](std::size_t channel) LAMINA_LAMBDA {
                const Float color = plan_.dither->color ? code_of_color(slab, channel) / largest
                                                        : color_of(slab, channel);
                return color * rounded;
            };
            blend(target_, {associated(0), associated(1), associated(2), rounded}, there);
        }
    }

    // Returns the code of a slab's opacity: dithered, or rounded as render.emulate says.
    Float code_of_alpha(int slab) const {
        const Float64 opacity =
            opacity_from_depth(load_float64(block_.precise_depths + at(slab)) * depth_scale_);
        const int number = block_.first_slab + slab;
        if (plan_.dither) {
            const int place = number % plan_.dither->period;
            return dithered_code(target_, opacity, *plan_.dither,
                                 slabs_.alpha_ranks[static_cast<std::size_t>(place)]);
        }
        Word random(0);
        if (target_.alpha_rounding == AlphaRounding::stochastic)
            random =
                random_of_pixels(column_, row_, static_cast<std::uint32_t>(number), target_.seed);
        return alpha_code(target_, opacity, random);
    }

    // Returns the code of a slab's colour: dithered, or the nearest.
    Float code_of_color(int slab, std::size_t channel) const {
        const Float color = color_of(slab, channel);
        if (!plan_.dither || !plan_.dither->color) return color_code(target_, color);
        const int place = (block_.first_slab + slab) % plan_.dither->period;
        return dithered_code(target_, Float64(clamp01(color)), *plan_.dither,
                             slabs_.color_ranks[static_cast<std::size_t>(place)]);
    }

    const CpuSlabs& slabs_;
    const SlicePlan& plan_;
    const TargetBlend& target_;
    SampleSpan span_;
    double depth_scale_;
    bool opacity_only_, behind_, as_codes_, colored_;
    int column_ = 0, row_ = 0;
    std::int64_t segments_ = 0;
    GroupRays rays_;
    SlabBlock block_;
    AnyCellIntegrator cells_;
};

std::int64_t blend_pixels(const CpuSlabs& slabs, const TargetBlend& target,
                          const TileGrid::Tile& area, TilePixels& pixels) {
    SlabBlender blender(slabs, target, {0, slabs.plan->slabs}, 1, false);
    for (std::size_t group = 0; group < tile_groups; ++group) {
        check_interrupt();
        Pixels there[group_packets];
        for (Pixels& pixel : there) pixel = {Float(0), Float(0), Float(0), Float(0)};
        blender.composite(area, group, there);
        for (std::size_t p = 0; p < group_packets; ++p) {
            const std::size_t place = packet_place(group, p);
            store(there[p].red, pixels.red.data() + place);
            store(there[p].green, pixels.green.data() + place);
            store(there[p].blue, pixels.blue.data() + place);
            store(there[p].alpha, pixels.alpha.data() + place);
        }
    }
    return blender.segments();
}

std::int64_t blend_opacities(const CpuSlabs& slabs, const TargetBlend& target,
                             const TileGrid::Tile& area, const SampleSpan& span, double depth_scale,
                             TilePixels::Plane& opacity) {
    SlabBlender blender(slabs, target, span, depth_scale, true);
    for (std::size_t group = 0; group < tile_groups; ++group) {
        Pixels there[group_packets];
        for (std::size_t p = 0; p < group_packets; ++p)
            there[p].alpha = load<Float>(opacity.data() + packet_place(group, p));
        blender.composite(area, group, there);
        for (std::size_t p = 0; p < group_packets; ++p)
            store(there[p].alpha, opacity.data() + packet_place(group, p));
    }
    return blender.segments();
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(blend_pixels);
LAMINA_EXPORT(blend_opacities);

std::int64_t blend_tile(const CpuSlabs& slabs, const TargetBlend& blend, const TileGrid::Tile& area,
                        TilePixels& pixels) {
    return LAMINA_DISPATCH(blend_pixels)(slabs, blend, area, pixels);
}

std::int64_t blend_tile_opacity(const CpuSlabs& slabs, const TargetBlend& blend,
                                const TileGrid::Tile& area, const SampleSpan& span,
                                double depth_scale, TilePixels::Plane& opacity) {
    return LAMINA_DISPATCH(blend_opacities)(slabs, blend, area, span, depth_scale, opacity);
}

}  // namespace lamina
#endif
