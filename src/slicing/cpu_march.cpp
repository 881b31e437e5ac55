// SPDX-License-Identifier: Apache-2.0
#include "slicing/cpu_slabs.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "slicing/cpu_march.cpp"
#include "simd/foreach_target.h"

#include "base/client.h"
#include "slicing/cpu_cells-inl.h"
#include "slicing/cpu_slab_block-inl.h"
#include "tiles/node_code-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

// Associated colour and optical depth of a node of the tree, for a vector of rays.
struct NodeSum {
    Float color[3];
    Float depth;
};

// Evaluates a compositing tree whose nodes are floats, for one group of packets at a time:
//   leaf: composite the slabs that may be visible, or the cells, front to back, brick by brick;
//         end rays that have become opaque
//   inner node: composite the children front to back, each rounded as its image would store it
class Marcher {
  public:
    Marcher(const CpuSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area)
        : slabs_(slabs),
          plan_(*slabs.plan),
          shape_(shape),
          single_color_(plan_.single_color),
          area_(area),
          cells_(cell_integrator(slabs, !plan_.single_color)) {}

    // Computes the root of the tree for each packet of a group, not yet rounded to the target.
    void evaluate(std::size_t group, NodeSum* sums) {
        group_ = group;
        if (slabs_.bricks.size() == 1)
            rays_.set_pixels(slabs_.rays, slabs_.bricks[0], area_, group_);
        evaluate(0, shape_.root(), sums);
    }

    std::int64_t segments() const { return segments_; }

  private:
    void evaluate(int level, const SampleSpan& node, NodeSum* sums) {
        if (shape_.is_marched(level, node)) {
            march(node, sums);
            return;
        }
        Float transmittance[group_packets];
        for (std::size_t p = 0; p < group_packets; ++p) {
            sums[p] = {{Float(0), Float(0), Float(0)}, Float(0)};
            transmittance[p] = Float(1.0f);
        }
        const int children = shape_.factor(level);
        for (int i = 0; i < children; ++i) {
            const SampleSpan child = child_span(node, i, children);
            if (child.count == 0) continue;
            NodeSum images[group_packets];
            evaluate(level + 1, child, images);
            for (std::size_t p = 0; p < group_packets; ++p)
                put_behind(stored(images[p], child.count), sums[p], transmittance[p]);
        }
    }

    LAMINA_INLINE void put_behind(const NodeSum& image, NodeSum& sum, Float& transmittance) const {
        sum.depth += image.depth;
        const Float weight = transmittance * opacity_from_depth(image.depth);
        transmittance -= weight;
        if (single_color_) return;
        for (int channel = 0; channel < 3; ++channel)
            sum.color[channel] += weight * image.color[channel];
    }

    // Returns a child as its image stores it, for its parent: optical depth and colour that is not
    // associated, both rounded to the image's format. `samples`: number of the child's slabs.
    NodeSum stored(const NodeSum& child, int samples) const {
        const TreePlan& tree = *plan_.tree;
        const float share = static_cast<float>(samples) / static_cast<float>(shape_.samples());
        const bool fine_alpha = plan_.target == Target::fixed8 && tree.alpha_bits == 16;
        const Float code = encode_depth(tree.code, child.depth, share);
        NodeSum image;
        image.depth = decode_depth(
            tree.code, in_format(fine_alpha ? Target::fixed16 : plan_.target, code), share);
        if (single_color_) return image;
        const Float opacity = opacity_from_depth(child.depth);
        const auto largest = static_cast<float>(tree.largest_color);
        const FloatMask some = opacity > 0;
        for (int channel = 0; channel < 3; ++channel) {
            const Float color = zero_unless(some, child.color[channel] / (opacity * largest));
            image.color[channel] = largest * in_format(plan_.target, color);
        }
        return image;
    }

    static Float in_format(Target target, Float value) {
        float largest = 255;
        switch (target) {
            case Target::float32:
                return value;
            case Target::float16:
                return truncate_to_half(value);
            case Target::fixed16:
                largest = 65535;
                break;
            case Target::fixed8:
            case Target::emulated:
                break;
        }
        return native_code(largest, value) / largest;
    }

    // The composite of a leaf's slabs, a sum of thousands of small terms. Within a block it is
    // summed in float, which loses nothing because opacity begins at 0; blocks are added in double.
    struct LeafSum {
        Float64 color[3], depth, transmittance;
    };

    // Composites all slabs of a leaf. Blocks count from the leaf's first slab whichever slabs are
    // wanted, so that rounding does not depend on these.
    void march(const SampleSpan& leaf, NodeSum* sums) {
        LeafSum leaves[group_packets];
        for (LeafSum& sum : leaves) sum = {{0, 0, 0}, 0, 1};
        bool opaque[group_packets] = {};
        for (const CpuBrickView& brick : slabs_.bricks) {
            if (slabs_.bricks.size() > 1) rays_.set_pixels(slabs_.rays, brick, area_, group_);
            rays_.set_slabs(slabs_, leaf.first, leaf.end());
            if (plan_.integrates_cells()) {
                std::visit([&](auto& cells)
                               LAMINA_LAMBDA { march_cells(brick, leaf, cells, leaves); },
                           cells_);
                continue;
            }
            const int blocks_end = (rays_.end_slab - leaf.first + block_slabs - 1) / block_slabs;
            for (int number = (rays_.first_slab - leaf.first) / block_slabs; number < blocks_end;
                 ++number) {
                block_.first_slab = leaf.first + number * block_slabs;
                for (std::size_t p = 0; p < group_packets; ++p) {
                    if (opaque[p]) continue;
                    block_.wanted = rays_.wanted(slabs_, p, number);
                    if (block_.wanted == 0) continue;
                    set_block(brick, p, number);
                    const LeafSum before = leaves[p];
                    add_block(leaves[p]);
                    if (plan_.ends_early()) opaque[p] = end_rays(before, leaves[p]);
                }
            }
        }
        for (std::size_t p = 0; p < group_packets; ++p) {
            sums[p].depth = to_float(leaves[p].depth);
            for (int channel = 0; channel < 3; ++channel)
                sums[p].color[channel] = to_float(leaves[p].color[channel]);
        }
    }

    // Composites a leaf cell by cell. A ray that has become opaque ends only after the cells that
    // were integrated in the same call of CellIntegrator::next().
    template <bool lit>
    void march_cells(const CpuBrickView& brick, const SampleSpan& leaf, CellIntegrator<lit>& cells,
                     LeafSum* leaves) {
        constexpr std::size_t together = CellIntegrator<lit>::most_packets;
        static_assert(group_packets % together == 0);
        const std::int64_t before = cells.segments();
        const auto end_opaque = [&](const LeafSum* sums) LAMINA_LAMBDA {
            for (std::size_t i = 0; plan_.ends_early() && i < together; ++i)
                cells.end_where(i, sums[i].depth, plan_.opaque_depth);
        };
        for (std::size_t p = 0; p < group_packets; p += together) {
            cells.begin(brick, rays_.packets + p, together, leaf.first);
            end_opaque(leaves + p);
            while (!cells.done()) {
                RaySum sums[together];
                cells.next(sums);
                for (std::size_t i = 0; i < together; ++i) put_behind(sums[i], leaves[p + i]);
                end_opaque(leaves + p);
            }
        }
        segments_ += cells.segments() - before;
    }

    // Sets the wanted slabs of a block; each range in a constant region becomes one slab.
    void set_block(const CpuBrickView& brick, std::size_t packet, int number) {
        const PacketRays& rays = rays_.packets[packet];
        const BlockMask constant = rays_.constant(slabs_, number, block_.wanted);
        block_.wanted ^= constant;
        segments_ += set_segments(slabs_, brick, rays, !single_color_, false, block_);
        block_.wanted ^= constant;
        for_each_range(constant, [&](int first, int end) {
            const OpticalProperties& optics =
                rays_.constant_optics(slabs_, block_.first_slab + first);
            set_constant_range(slabs_, optics, rays, !single_color_, first, end, block_);
        });
    }

    // Undoes what a block added to rays that were opaque before it, so that each pixel ends by
    // itself, independent of its neighbours. Returns whether all rays are opaque now.
    LAMINA_INLINE bool end_rays(const LeafSum& before, LeafSum& leaf) const {
        const double opaque = plan_.opaque_depth;
        const Float64Mask ended = before.depth >= opaque;
        for (int channel = 0; channel < 3; ++channel)
            leaf.color[channel] = select(ended, before.color[channel], leaf.color[channel]);
        leaf.transmittance = select(ended, before.transmittance, leaf.transmittance);
        leaf.depth = select(ended, before.depth, leaf.depth);
        return all_of(leaf.depth >= opaque);
    }

    Float block_depth() const {
        Float depth(0);
        for_each_range(block_.wanted, [&](int first, int end) LAMINA_LAMBDA {
            for (int i = first; i < end; ++i) depth += load<Float>(block_.depths + at(i));
        });
        return depth;
    }

    LAMINA_INLINE void add_block(LeafSum& leaf) const {
        if (single_color_) {
            leaf.depth += Float64(block_depth());
            return;
        }
        RaySum sum = empty_sum();
        const auto put_slab_behind = [&](int i) LAMINA_LAMBDA {
            const Float depth = load<Float>(block_.depths + at(i));
            const Float kept = 1.0f - sum.opacity;
            const Float weight = kept * opacity_from_depth(depth);
            for (int channel = 0; channel < 3; ++channel)
                sum.color[channel] += weight * load<Float>(block_.colors[channel] + at(i));
            sum.opacity += weight;
            sum.depth += depth;
        };
        for_each_range(block_.wanted, [&](int first, int end) LAMINA_LAMBDA {
            for (int i = first; i < end; ++i) put_slab_behind(i);
        });
        put_behind(sum, leaf);
    }

    LAMINA_INLINE void put_behind(const RaySum& next, LeafSum& leaf) const {
        leaf.depth += Float64(next.depth);
        if (single_color_) return;
        for (int channel = 0; channel < 3; ++channel) {
            leaf.color[channel] += leaf.transmittance * Float64(next.color[channel]);
        }
        leaf.transmittance *= 1 - Float64(next.opacity);
    }

    const CpuSlabs& slabs_;
    const SlicePlan& plan_;
    const TreeShape& shape_;
    bool single_color_;
    const TileGrid::Tile& area_;
    std::size_t group_ = 0;
    std::int64_t segments_ = 0;
    GroupRays rays_;
    SlabBlock block_;
    AnyCellIntegrator cells_;
};

std::int64_t march_pixels(const CpuSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area,
                          TilePixels& pixels) {
    const Target target = slabs.plan->target;
    const bool codes = is_fixed_point(target);
    const float largest = codes ? static_cast<float>(largest_code(slabs.plan->code_bits())) : 1.0f;
    const bool single = slabs.plan->single_color;
    const auto put = [&](Float value, TilePixels::Plane& plane, std::size_t place) LAMINA_LAMBDA {
        if (codes) value = native_code(largest, value);
        if (target == Target::float16) value = truncate_to_half(value);
        store(value, plane.data() + place);
    };
    Marcher marcher(slabs, shape, area);
    for (std::size_t group = 0; group < tile_groups; ++group) {
        check_interrupt();  // a tile of a tree of 2^16 leaves takes a minute
        NodeSum sums[group_packets];
        marcher.evaluate(group, sums);
        for (std::size_t p = 0; p < group_packets; ++p) {
            const std::size_t place = packet_place(group, p);
            const Float opacity = opacity_from_depth(sums[p].depth);
            const auto color = [&](std::size_t channel) LAMINA_LAMBDA {
                return single ? slabs.single_color[channel] * opacity : sums[p].color[channel];
            };
            put(color(0), pixels.red, place);
            put(color(1), pixels.green, place);
            put(color(2), pixels.blue, place);
            put(opacity, pixels.alpha, place);
        }
    }
    return marcher.segments();
}

LAMINA_SIMD_END

#if LAMINA_ONCE
namespace lamina {

LAMINA_EXPORT(march_pixels);

std::int64_t march_tile(const CpuSlabs& slabs, const TreeShape& shape, const TileGrid::Tile& area,
                        TilePixels& pixels) {
    return LAMINA_DISPATCH(march_pixels)(slabs, shape, area, pixels);
}

}  // namespace lamina
#endif
