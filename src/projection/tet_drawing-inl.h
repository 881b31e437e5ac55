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

#include "projection/tet_coverage-inl.h"
#include "tiles/target_pixels-inl.h"

LAMINA_SIMD_BEGIN

LAMINA_INLINE Pixels load_pixels(const TilePixels& pixels, std::size_t place) {
    return {load<Float>(pixels.red.data() + place), load<Float>(pixels.green.data() + place),
            load<Float>(pixels.blue.data() + place), load<Float>(pixels.alpha.data() + place)};
}

LAMINA_INLINE void store_pixels(const Pixels& there, TilePixels& pixels, std::size_t place) {
    store(there.red, pixels.red.data() + place);
    store(there.green, pixels.green.data() + place);
    store(there.blue, pixels.blue.data() + place);
    store(there.alpha, pixels.alpha.data() + place);
}

class TetDrawing {
  public:
    TetDrawing(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile)
        : fragments_(fragments), batch_(batch), tile_(tile), coverage_(fragments, tile) {}

    template <class Shader>
    LAMINA_INLINE void draw(const Shader& shader) {
        batch_.for_each_word(tile_.number, [&](std::size_t first, std::uint64_t parts)
                                               LAMINA_LAMBDA { draw_parts(shader, first, parts); });
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
    LAMINA_INLINE void draw_parts(const Shader& shader, std::size_t first, std::uint64_t parts) {
        std::size_t count = 0;
        for_each_member(first, parts, [&](std::size_t part) { blocks_[count++].part = part; });
        for (std::size_t i = 0; i < count; ++i)
            blocks_[i].blocks = coverage_.blocks(batch_.area(blocks_[i].part));
        for (std::size_t i = 0; i < count; ++i) {
            const auto [blocks, part] = blocks_[i];
            coverage_.find<Shader::lit>(shader.cut, batch_.record(part), batch_.area(part), blocks,
                                        part, queue_);
            if (queue_.is_full()) draw_queue(shader);
        }
    }

    // It is not inlined, because only then does GCC inline the shader into it.
    template <class Shader>
    LAMINA_NOINLINE void draw_queue(const Shader& shader) {
        if constexpr (Shader::lit) {
            queue_.for_each_vector([&](std::size_t part, std::size_t i) LAMINA_LAMBDA {
                queue_.set_color(i, shader.lit_color(batch_, part, queue_.placed(i)));
            });
        } else {
            find_colors(shader);
        }
        queue_.for_each_place([&](const FragmentQueue::Place& pixels,
                                  const Fragment& color) LAMINA_LAMBDA {
            shader.put(fragments_, batch_.record(pixels.part).number(), color, tile_, pixels.place);
        });
        queue_.clear();
    }

    template <class Shader>
    LAMINA_INLINE void find_colors(const Shader& shader) {
        queue_.for_each_vector([&](std::size_t part, std::size_t i) LAMINA_LAMBDA {
            const SilhouetteRecord& record = batch_.record(part);
            if (has_exact_runs(fragments_, batch_.area(part))) {
                const bool slanted = tile_.slants != nullptr;
                queue_.set_run(
                    i, find_exact_run(shader, fragments_, record, queue_.placed(i), slanted));
            } else {
                queue_.set_run(i, find_run(shader, fragments_, record, queue_.slanted(i)));
            }
        });
        queue_.for_each_vector([&](std::size_t part, std::size_t i) LAMINA_LAMBDA {
            queue_.set_color(
                i, shader.color(fragments_, batch_.record(part), batch_.area(part), queue_.run(i)));
        });
    }

    const TetFragments& fragments_;
    const TileBatch& batch_;
    const TetTile& tile_;
    TetCoverage coverage_;
    Blocks blocks_[64];  // of the cell fragments of a word
    FragmentQueue queue_;
};

LAMINA_SIMD_END

#endif
