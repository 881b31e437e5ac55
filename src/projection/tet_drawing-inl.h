// SPDX-License-Identifier: Apache-2.0
// Draws cell fragments over the pixels of a tile. A `Shader` says how fragments are drawn. It has
// the constant `lit`; `cut`, `scalars`, `perspective` and `opacity_only` (constants or members);
// and the functions color() (lit: lit_color()) and put().
#if defined(LAMINA_PROJECTION_TET_DRAWING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_DRAWING_INL_H_
#undef LAMINA_PROJECTION_TET_DRAWING_INL_H_
#else
#define LAMINA_PROJECTION_TET_DRAWING_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/tet_coverage-inl.h"
#include "tiles/target_pixels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lamina::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Pixels<Vector> load_pixels(Tag d, const TilePixels& pixels, std::size_t place) {
    return {hn::Load(d, pixels.red.data() + place), hn::Load(d, pixels.green.data() + place),
            hn::Load(d, pixels.blue.data() + place), hn::Load(d, pixels.alpha.data() + place)};
}

HWY_INLINE void store_pixels(Tag d, const Pixels<Vector>& there, TilePixels& pixels,
                             std::size_t place) {
    hn::Store(there.red, d, pixels.red.data() + place);
    hn::Store(there.green, d, pixels.green.data() + place);
    hn::Store(there.blue, d, pixels.blue.data() + place);
    hn::Store(there.alpha, d, pixels.alpha.data() + place);
}

class TetDrawing {
  public:
    TetDrawing(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile)
        : fragments_(fragments), batch_(batch), tile_(tile), coverage_(fragments, tile) {}

    template <class Shader>
    HWY_INLINE void draw(const Shader& shader) {
        batch_.for_each_word(tile_.number, [&](std::size_t first, std::uint64_t parts)
                                               HWY_ATTR { draw_parts(shader, first, parts); });
        draw_queue(shader);
    }
    std::int64_t fragments() const { return coverage_.fragments(); }

  private:
    struct Blocks {
        std::uint64_t blocks;
        std::size_t part;
    };

    // `parts`: as in TileBatch::for_each_word().
    template <class Shader>
    HWY_INLINE void draw_parts(const Shader& shader, std::size_t first, std::uint64_t parts) {
        std::size_t count = 0;
        for_each_member(first, parts, [&](std::size_t part) HWY_ATTR {
            blocks_[count++] = {coverage_.blocks(batch_.area(part)), part};
        });
        for (std::size_t i = 0; i < count; ++i) {
            const auto [blocks, part] = blocks_[i];
            coverage_.find<Shader::lit>(shader.cut, batch_.record(part), batch_.area(part), blocks,
                                        part, queue_);
            if (queue_.is_full()) draw_queue(shader);
        }
    }

    // It is not inlined, because only then does GCC inline the shader into it.
    template <class Shader>
    HWY_NOINLINE void draw_queue(const Shader& shader) {
        if constexpr (Shader::lit) {
            queue_.for_each_vector([&](std::size_t part, std::size_t i) HWY_ATTR {
                queue_.set_color(d_, i, shader.lit_color(batch_, part, queue_.found(d_, i)));
            });
        } else {
            find_colors(shader);
        }
        queue_.for_each_place(
            d_, [&](const FragmentQueue::Place& pixels, const Fragment<Vector>& color) HWY_ATTR {
                shader.put(d_, fragments_, batch_.record(pixels.part).number, color, tile_,
                           pixels.place);
            });
        queue_.clear();
    }

    template <class Shader>
    HWY_INLINE void find_colors(const Shader& shader) {
        queue_.for_each_vector([&](std::size_t part, std::size_t i) HWY_ATTR {
            const FragmentQueue::Found found = queue_.found(d_, i);
            const TetRecord& record = batch_.record(part);
            const bool slanted = tile_.slants != nullptr;
            queue_.set_run(d_, i,
                           has_exact_runs(fragments_, batch_.area(part))
                               ? find_exact_run(d_, shader, fragments_, record, found.span,
                                                found.aside, found.slant, slanted)
                               : find_run(d_, shader, fragments_, record, found.span, found.aside,
                                          found.slant));
        });
        queue_.for_each_vector([&](std::size_t part, std::size_t i) HWY_ATTR {
            queue_.set_color(d_, i,
                             shader.color(d_, fragments_, batch_.record(part), batch_.area(part),
                                          queue_.run(d_, i)));
        });
    }

    const TetFragments& fragments_;
    const TileBatch& batch_;
    const TetTile& tile_;
    Tag d_;
    TetCoverage coverage_;
    Blocks blocks_[64];  // of the cell fragments of a word
    FragmentQueue queue_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
