// SPDX-License-Identifier: Apache-2.0
// Draws the cell fragments of a batch over the pixels of one tile, back to front. Fragment, without
// "cell", is the word of rasterisers: one pixel of one cell fragment.
//
//   for each cell fragment of the tile:
//       blocks = the blocks of pixels inside its silhouette                TetCoverage::blocks()
//       for each vector of pixels in these blocks:
//           enter, leave = depths of the rays on its front and back faces  TetCoverage::find_in()
//           put the pixels whose rays meet the cell fragment into the queue         FragmentQueue
//       if the queue is full, and at the end:                            TetDrawing::draw_queue()
//           for each vector of fragments: the ray's segment, its length and the scalars at its ends
//           for each vector of fragments: colour and opacity                      Shader::color()
//           for each vector of pixels: composite onto the tile                      Shader::put()
//
// A Shader is GeneralShader, LitShader or CellFragmentShader. It has the constant `lit`; `cut`,
// `scalars`, `perspective` and `opacity_only`, as constants or members; color(), or lit_color() if
// it is lit; and put().
#if defined(LAMINA_PROJECTION_TET_DRAWING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LAMINA_PROJECTION_TET_DRAWING_INL_H_
#undef LAMINA_PROJECTION_TET_DRAWING_INL_H_
#else
#define LAMINA_PROJECTION_TET_DRAWING_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "projection/fragment_segment-inl.h"
#include "simd/members-inl.h"

LAMINA_SIMD_BEGIN

// Fragments that wait to be shaded. They are added as vectors of 4 x 1, 4 x 2 or 4 x 4 pixels,
// about half of which a cell fragment covers. With AVX-512 the queue packs the covered pixels of
// one cell fragment into full vectors, so that few colours are computed in vain. Each step of
// shading is done for the whole queue before the next step begins: its vectors do not depend on
// each other, so the processor works on several at a time.
class FragmentQueue {
  public:
    static constexpr std::size_t lanes = Float::lanes;

    // A vector of pixels that a cell fragment covers, at least in part.
    struct Place {
        std::uint16_t place;   // TileGrid::place() of the first pixel
        std::uint16_t number;  // index of the cell fragment in the TileBatch
    };

    bool is_full() const { return end_ >= enough; }  // may not hold one that covers the tile
    void clear() { end_ = place_count_ = 0; }

    // Adds the fragments of one cell fragment to the queue.
    class Writer {
      public:
        LAMINA_INLINE Writer(FragmentQueue& queue, std::size_t number)
            : queue_(queue),
              number_(static_cast<std::uint16_t>(number)),
              to_(queue.values_ + position(0, queue.end_)),
              place_(queue.places_ + queue.place_count_) {}

        LAMINA_INLINE void add(std::size_t place, const SlantedRay& found, FloatMask inside) {
            add(place, found.span, found.aside, found.slant, inside);
        }
        LAMINA_INLINE void add(std::size_t place, const PlacedRay& found, FloatMask inside) {
            add(place, found.span, found.column, found.row, inside);
        }
        // Call this after the last add(). Returns how many fragments were added.
        LAMINA_INLINE std::size_t finish() {
            if constexpr (packs) {
                for (std::size_t i = 0; i < values; ++i) put(i, 0);
            }
            const auto written = static_cast<std::size_t>(to_ - queue_.values_);
            const std::size_t end =
                packs ? (written + lanes - 1) / lanes * lanes : written / values;
            // Sets the number of all new vectors. A fill of fixed length, mostly enough, needs no
            // branch, which could not be predicted.
            std::uint16_t* const numbers = queue_.numbers_ + queue_.end_ / lanes;
            const std::size_t vectors = (end - queue_.end_) / lanes;
            std::fill_n(numbers, first_fill, number_);
            if (vectors > first_fill)
                std::fill_n(numbers + first_fill, vectors - first_fill, number_);
            queue_.end_ = end;
            queue_.place_count_ = static_cast<std::size_t>(place_ - queue_.places_);
            return count_;
        }

      private:
        // Writes the vector behind the end, and moves the end if a pixel is `inside`. There is no
        // branch, because it could not be predicted. Pixels that are not inside get an empty span,
        // so that their `third` and `fourth` value do not matter.
        LAMINA_INLINE void add(std::size_t place, const InsideSpan<Float>& span, Float third,
                               Float fourth, FloatMask inside) {
            const std::size_t count = count_of(inside), some = count > 0 ? 1 : 0;
            *place_ = {static_cast<std::uint16_t>(place), number_};
            if constexpr (packs) {
                put(0, members_first(span.enter, inside));
                put(1, members_first(span.leave, inside));
                put(2, members_first(third, inside));
                put(3, members_first(fourth, inside));
                Packed& packed = queue_.packed_[place_ - queue_.places_];
                packed.first = static_cast<std::uint16_t>(to_ - queue_.values_);
                packed.inside = static_cast<std::uint16_t>(bits_of(inside));
                to_ += count;
            } else {
                put(0, zero_unless(inside, span.enter));
                put(1, zero_unless(inside, span.leave));
                put(2, third);
                put(3, fourth);
                to_ += some * (values * lanes);
            }
            place_ += some;
            count_ += count;
        }
        LAMINA_INLINE void put(std::size_t value, Float v) {
            store_unaligned(v, to_ + position(value, 0));
        }

        FragmentQueue& queue_;
        std::uint16_t number_;
        float* to_;
        Place* place_;
        std::size_t count_ = 0;
    };

    // Calls visit(number, i) for each vector of fragments. `number`: that of their cell fragment;
    // `i`: index of the first fragment in the queue.
    template <class Visit>
    LAMINA_INLINE void for_each_vector(const Visit& visit) const {
        for (std::size_t i = 0; i < end_; i += lanes) visit(std::size_t{numbers_[i / lanes]}, i);
    }
    // Calls visit(Place, color) for each vector of pixels. Pixels not covered have colour 0.
    template <class Visit>
    LAMINA_INLINE void for_each_place(const Visit& visit) const {
        for (std::size_t i = 0; i < place_count_; ++i) {
            const auto channel = [&](std::size_t value) LAMINA_LAMBDA { return pixels(value, i); };
            visit(places_[i], Fragment{channel(0), channel(1), channel(2), channel(3)});
        }
    }

    // The queue has four values for each fragment. Each step of shading replaces them: a SlantedRay
    // or PlacedRay becomes a FragmentSegment (unless it is lit), and this becomes a colour.
    LAMINA_INLINE SlantedRay slanted(std::size_t i) const {
        return {{value(0, i), value(1, i)}, value(2, i), value(3, i)};
    }
    LAMINA_INLINE PlacedRay placed(std::size_t i) const {
        return {{value(0, i), value(1, i)}, value(2, i), value(3, i)};
    }
    LAMINA_INLINE void set_segment(std::size_t i, const FragmentSegment& segment) {
        put(0, i, segment.front);
        put(1, i, segment.back);
        put(2, i, segment.world_length);
    }
    LAMINA_INLINE FragmentSegment segment(std::size_t i) const {
        return {value(0, i), value(1, i), value(2, i)};
    }
    LAMINA_INLINE void set_color(std::size_t i, const Fragment& color) {
        put(0, i, color.red);
        put(1, i, color.green);
        put(2, i, color.blue);
        put(3, i, color.alpha);
    }

  private:
    static_assert(TileBatch::most_chunks * TileBatch::chunk_size <= 1 << 16,
                  "numbers of cell fragments are kept in 16 bits");
    static constexpr bool packs = packs_quickly;
    static constexpr std::size_t values = 4, enough = 256, most = enough + TileGrid::pixels + lanes,
                                 first_fill = 16;
    // The packed fragments of a vector of pixels.
    struct Packed {
        std::uint16_t first;   // index of the first fragment in the queue
        std::uint16_t inside;  // a bit for each pixel: 1 if it has a fragment
    };

    // Returns the index in values_ of a value (0 to 3) of fragment i. With packing, a vector of
    // pixels begins at any fragment, so each of the four values has an array of its own. Without
    // packing, the four values of a vector follow each other.
    static constexpr std::size_t position(std::size_t value, std::size_t i) {
        return packs ? value * most + i : value * lanes + i * values;
    }
    LAMINA_INLINE Float pixels(std::size_t number, std::size_t place) const {
        if constexpr (!packs) return value(number, place * lanes);
        const Packed& packed = packed_[place];
        return expand_members(packed.inside, values_ + position(number, packed.first));
    }
    LAMINA_INLINE void put(std::size_t number, std::size_t i, Float v) {
        store(v, values_ + position(number, i));
    }
    LAMINA_INLINE Float value(std::size_t number, std::size_t i) const {
        return load<Float>(values_ + position(number, i));
    }

    std::size_t end_ = 0, place_count_ = 0;
    // For each vector of fragments, the number of the cell fragment.
    std::uint16_t numbers_[most / lanes + first_fill];
    Place places_[enough + TileGrid::pixels / lanes + 1];
    Packed packed_[packs ? enough + TileGrid::pixels / lanes + 1 : 1];
    alignas(64) float values_[values * most];
};

// Returns the blocks of a tile that the area's rectangle of pixels touches. Here and below a set of
// blocks has one bit for each block of the tile, row by row from the top left one.
inline std::uint64_t blocks_of(const CoveredArea& area, const TileGrid::Tile& tile) {
    constexpr int a_row = TileGrid::edge / TileGrid::block;
    const auto in_tile = [](int pixel, int first) {
        return std::clamp(pixel - first, 0, TileGrid::edge - 1) / TileGrid::block;
    };
    const int first_column = in_tile(area.first_column, tile.column),
              last_column = in_tile(area.last_column, tile.column);
    const int first_row = in_tile(area.first_row, tile.row),
              last_row = in_tile(area.last_row, tile.row);
    const std::uint64_t columns =
        (0xffull >> (a_row - 1 - last_column)) & (0xffull << first_column);
    const std::uint64_t rows =
        (~0ull >> a_row * (a_row - 1 - last_row)) & (~0ull << a_row * first_row);
    return rows & (columns * 0x0101010101010101ull);
}

// Calls visit(column, row) with the first pixel of each block in the set.
template <class Visit>
LAMINA_INLINE void for_each_block(std::uint64_t blocks, const Visit& visit) {
    constexpr int a_row = TileGrid::edge / TileGrid::block;
    for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
        const int number = std::countr_zero(left);
        visit(number % a_row * TileGrid::block, number / a_row * TileGrid::block);
    }
}

// Finds the pixels of a tile that cell fragments cover, and counts them.
class TetCoverage {
  public:
    TetCoverage(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile), area_(tile.area) {}

    // Returns a set of blocks that contains all blocks that the cell fragment covers.
    LAMINA_INLINE std::uint64_t blocks(const CoveredArea& area) const {
        return blocks_of(area, area_) & blocks_within(area);
    }

    // Adds the pixels of `blocks` that a cell fragment covers to the queue. `number`: its index in
    // the batch. `cut`: it may end at planes of constant scalar (FragmentCuts). `lit`: it is lit.
    template <bool lit>
    LAMINA_INLINE void find(bool cut, const SilhouetteRecord& record, const CoveredArea& area,
                            std::uint64_t blocks, std::size_t number, FragmentQueue& found) {
        // Blocks at the picture's right and lower edge may reach beyond it.
        const bool whole_blocks = area_.width % block == 0 && area_.height % block == 0;
        FragmentQueue::Writer writer(found, number);
        if (has_exact_segments(fragments_, area)) {
            find_in<true, true, CarefulDepths>(cut, record, area, blocks, writer);
        } else if (area.careful) {
            find_in<lit, true, CarefulDepths>(cut, record, area, blocks, writer);
        } else if (area.bounded || !whole_blocks) {
            find_in<lit, true, PlainDepths>(cut, record, area, blocks, writer);
        } else {
            find_in<lit, false, PlainDepths>(cut, record, area, blocks, writer);
        }
        count_ += static_cast<std::int64_t>(writer.finish());
    }
    std::int64_t fragments() const { return count_; }

  private:
    static constexpr int block = TileGrid::block, blocks_a_row = TileGrid::edge / TileGrid::block;

    float from_column(const SeenTet& record) const {
        return static_cast<float>(area_.column) + 0.5f - record.center[0];
    }
    float from_row(const SeenTet& record) const {
        return static_cast<float>(fragments_.image_rows - area_.row) - 0.5f - record.center[1];
    }

    // Returns the set of the tile's blocks within the outline of a cell fragment (TetOutline).
    LAMINA_INLINE std::uint64_t blocks_within(const CoveredArea& area) const {
        constexpr float a_block = 1.0f / block;
        const auto pixels = [](std::int32_t from, std::int32_t to) {
            return static_cast<float>(to - from);
        };
        // The bound of each line on the columns of blocks in the tile's first row of blocks. 1/2 is
        // added, because whole() below rounds to the nearest number.
        const Float4 per_row = load_unaligned<Float4>(area.outline.per_row.data());
        const Float4 bound = (load_unaligned<Float4>(area.outline.at_first.data()) +
                              per_row * pixels(area.first_row, area_.row) -
                              pixels(area.first_column, area_.column)) *
                                 a_block +
                             0.5f;
        const auto is_least = mask_of_bits<Float4::Mask>(area.outline.least);
        constexpr float beyond = blocks_a_row;
        alignas(16) float least[4], least_per_row[4], greatest[4], greatest_per_row[4];
        store(zero_unless(is_least, bound), least);
        store(zero_unless(is_least, per_row), least_per_row);
        store(select(is_least, beyond, bound), greatest);
        store(zero_if(is_least, per_row), greatest_per_row);
        // Floats from 2^23 on are whole: adding 2^23 rounds, and puts the number in the low bits.
        const auto whole = [](Float8 v) LAMINA_LAMBDA { return bits_as<Word8>(v + 0x1p23f); };
        // Returns 2^v, by making v the exponent of a float.
        const auto power = [&](Float8 v) LAMINA_LAMBDA {
            return bits_as<Float8>(shift_left<23>(whole(v) + 127u));
        };
        std::uint8_t bits[blocks_a_row];
        for (std::size_t row = 0; row < blocks_a_row; row += Float8::lanes) {
            const Float8 rows = iota<Float8>(static_cast<float>(row));
            Float8 first(0), end(beyond);
            for (std::size_t i = 0; i < 4; ++i) {
                first = max(first, least[i] + least_per_row[i] * rows);
                end = min(end, greatest[i] + greatest_per_row[i] * rows);
            }
            first = min(first, beyond);
            end = max(end, 0);
            // 2^end - 2^first has the bits `first` to `end` - 1, one for each block.
            const Float8 some = max(power(end) - power(first), 0);
            store_low_bytes(whole(some), bits + row);
        }
        std::uint64_t within;
        std::memcpy(&within, bits, sizeof(within));
        return within;
    }

    // Prefetches the pixels of a block, onto which its fragments will be composited.
    LAMINA_INLINE void prefetch_pixels(std::size_t first) const {
        if (tile_.pixels == nullptr) return;
        __builtin_prefetch(tile_.pixels->red.data() + first);
        __builtin_prefetch(tile_.pixels->green.data() + first);
        __builtin_prefetch(tile_.pixels->blue.data() + first);
        __builtin_prefetch(tile_.pixels->alpha.data() + first);
    }

    // Finds the fragments in `blocks` and writes them to the queue, as PlacedRays (`placed`) or as
    // SlantedRays. `bounded`: pixels are limited to the rectangle of `area`, and segments end at
    // area.farthest. `Depths`: PlainDepths or CarefulDepths.
    template <bool placed, bool bounded, class Depths>
    LAMINA_INLINE void find_in(bool cut, const SilhouetteRecord& record, const CoveredArea& area,
                               std::uint64_t blocks, FragmentQueue::Writer& writer) const {
        constexpr int rows_a_vector = static_cast<int>(FragmentQueue::lanes) / block;
        const float first_column = from_column(record.seen()), first_row = from_row(record.seen());
        const auto column_of = [&](int pixel) {
            return first_column + static_cast<float>(pixel - area_.column);
        };
        const auto row_of = [&](int pixel) {
            return first_row - static_cast<float>(pixel - area_.row);
        };
        const float first_in = column_of(area.first_column), last_in = column_of(area.last_column);
        const float highest = row_of(area.first_row), lowest = row_of(area.last_row);
        // Read before the loop. In it they would be read again each time, because the compiler
        // cannot exclude that writing to the queue changes the record.
        const Float scalar_per_column(record.seen().scalar_per_column),
            scalar_per_row(record.seen().scalar_per_row);
        const float* const slants = tile_.slants;
        const Depths depths(fragments_, record);
        const FragmentCuts cuts(cut, record.fragment);
        for (std::uint64_t left = blocks; left != 0; left &= left - 1) {
            const auto number = static_cast<std::size_t>(std::countr_zero(left));
            prefetch_pixels(number * block * block);
            const Float columns = first_column + load<Float>(block_columns.data() +
                                                             number % blocks_a_row * block * block);
            const auto at_columns = depths.at_columns(columns);
            for (int y = 0; y < block; y += rows_a_vector) {
                const std::size_t step = static_cast<std::size_t>(y) * block;
                const Float rows = first_row - load<Float>(block_rows.data() + step +
                                                           number / blocks_a_row * block * block);
                InsideSpan<Float> span = depths.at(at_columns, rows);
                if constexpr (bounded) span.leave = min(span.leave, area.farthest);
                cuts.shorten(record.fragment, columns, rows, span);
                FloatMask inside = span.leave > span.enter;
                if constexpr (bounded) {
                    const FloatMask in_columns = (columns >= first_in) & (columns <= last_in);
                    const FloatMask in_rows = (rows >= lowest) & (rows <= highest);
                    inside = inside & (in_columns & in_rows);
                }
                const std::size_t place = number * block * block + step;
                if constexpr (placed) {
                    writer.add(place, PlacedRay{span, columns, rows}, inside);
                    continue;
                }
                const Float slant = slants != nullptr ? load<Float>(slants + place) : Float(1);
                const Float aside = columns * scalar_per_column + rows * scalar_per_row;
                writer.add(place, SlantedRay{span, aside, slant}, inside);
            }
        }
    }

    // For the pixels of the tile's first row of blocks, their columns; for those of its first
    // column of blocks, their rows. Both count from the tile's first pixel, block after block.
    struct alignas(64) PixelRow : std::array<float, TileGrid::edge * TileGrid::block> {};
    static constexpr PixelRow block_columns = [] {
        PixelRow columns{};
        for (int i = 0; i < TileGrid::edge * block; ++i)
            columns[static_cast<std::size_t>(i)] =
                static_cast<float>(i / (block * block) * block + i % block);
        return columns;
    }();
    static constexpr PixelRow block_rows = [] {
        PixelRow rows{};
        for (int i = 0; i < TileGrid::edge * block; ++i)
            rows[static_cast<std::size_t>(i)] = static_cast<float>(i / block);
        return rows;
    }();

    const TetFragments& fragments_;
    const TetTile& tile_;
    const TileGrid::Tile& area_;
    std::int64_t count_ = 0;
};

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

// Draws the cell fragments of a batch over a tile.
class TetDrawing {
  public:
    TetDrawing(const TetFragments& fragments, const TileBatch& batch, const TetTile& tile)
        : fragments_(fragments), batch_(batch), tile_(tile), coverage_(fragments, tile) {}

    template <class Shader>
    LAMINA_INLINE void draw(const Shader& shader) {
        batch_.for_each_word(tile_.number, [&](std::size_t first, std::uint64_t word)
                                               LAMINA_LAMBDA { draw_word(shader, first, word); });
        draw_queue(shader);
    }
    std::int64_t fragments() const { return coverage_.fragments(); }

  private:
    // A cell fragment and the set of the tile's blocks that it may cover.
    struct Blocks {
        std::uint64_t blocks;
        std::size_t number;  // index of the cell fragment in the batch
    };

    // Draws up to 64 cell fragments. `first`, `word`: as in TileBatch::for_each_word().
    template <class Shader>
    LAMINA_INLINE void draw_word(const Shader& shader, std::size_t first, std::uint64_t word) {
        std::size_t count = 0;
        for_each_member(first, word, [&](std::size_t number) { blocks_[count++].number = number; });
        for (std::size_t i = 0; i < count; ++i)
            blocks_[i].blocks = coverage_.blocks(batch_.area(blocks_[i].number));
        for (std::size_t i = 0; i < count; ++i) {
            const auto [blocks, number] = blocks_[i];
            coverage_.find<Shader::lit>(shader.cut, batch_.record(number), batch_.area(number),
                                        blocks, number, queue_);
            if (queue_.is_full()) draw_queue(shader);
        }
    }

    // Shades the fragments in the queue, composites them onto the tile, and clears the queue. This
    // is not inlined, because only then does GCC inline the Shader's functions into it.
    template <class Shader>
    LAMINA_NOINLINE void draw_queue(const Shader& shader) {
        if constexpr (Shader::lit) {
            queue_.for_each_vector([&](std::size_t number, std::size_t i) LAMINA_LAMBDA {
                queue_.set_color(i, shader.lit_color(batch_, number, queue_.placed(i)));
            });
        } else {
            find_colors(shader);
        }
        queue_.for_each_place([&](const FragmentQueue::Place& pixels, const Fragment& color)
                                  LAMINA_LAMBDA {
                                      shader.put(fragments_, batch_.record(pixels.number).number(),
                                                 color, tile_, pixels.place);
                                  });
        queue_.clear();
    }

    // Computes the segments of all fragments in the queue, then their colours.
    template <class Shader>
    LAMINA_INLINE void find_colors(const Shader& shader) {
        queue_.for_each_vector([&](std::size_t number, std::size_t i) LAMINA_LAMBDA {
            const SilhouetteRecord& record = batch_.record(number);
            if (has_exact_segments(fragments_, batch_.area(number))) {
                const bool slanted = tile_.slants != nullptr;
                queue_.set_segment(
                    i, find_exact_segment(shader, fragments_, record, queue_.placed(i), slanted));
            } else {
                const SlantedRay ray = queue_.slanted(i);
                const TetSpan ends = find_ends(shader, fragments_, record, ray.span, ray.slant);
                queue_.set_segment(i, segment_between(shader, record, ends, ray.aside));
            }
        });
        queue_.for_each_vector([&](std::size_t number, std::size_t i) LAMINA_LAMBDA {
            queue_.set_color(i, shader.color(fragments_, batch_.record(number), batch_.area(number),
                                             queue_.segment(i)));
        });
    }

    const TetFragments& fragments_;
    const TileBatch& batch_;
    const TetTile& tile_;
    TetCoverage coverage_;
    Blocks blocks_[64];  // for the cell fragments that draw_word() draws
    FragmentQueue queue_;
};

LAMINA_SIMD_END

#endif
