// SPDX-License-Identifier: Apache-2.0
// Parts of tets over the pixels of a tile. A `Shading` says what is known of how fragments are
// computed: `cut`, `scalars`, `perspective` (constants, or members that are asked at each vector of
// pixels), color() and put().
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
    TetDrawing(const TetFragments& fragments, const TetTile& tile)
        : fragments_(fragments), tile_(tile), coverage_(fragments, tile.area) {}

    template <class Shading>
    HWY_INLINE void draw(const Shading& shading, const TetRecord& record, const PartArea& area) {
        CoveredPixels covered;
        if (shading.cut) {
            coverage_.find<true>(record, area, covered);
        } else {
            coverage_.find<false>(record, area, covered);
        }
        // Two at a time: one alone is a long chain of operations that wait for one another.
        std::size_t i = 0;
        for (; i + 2 <= covered.count(); i += 2) {
            const Fragment<Vector> first = color_of(shading, record, covered, i);
            const Fragment<Vector> second = color_of(shading, record, covered, i + 1);
            shading.put(d_, fragments_, record, first, tile_, covered.place(i));
            shading.put(d_, fragments_, record, second, tile_, covered.place(i + 1));
        }
        if (i < covered.count()) {
            shading.put(d_, fragments_, record, color_of(shading, record, covered, i), tile_,
                        covered.place(i));
        }
    }
    std::int64_t fragments() const { return coverage_.fragments(); }

  private:
    template <class Shading>
    HWY_INLINE Fragment<Vector> color_of(const Shading& shading, const TetRecord& record,
                                         const CoveredPixels& covered, std::size_t i) const {
        const Vector slant = tile_.slants != nullptr ? hn::Load(d_, tile_.slants + covered.place(i))
                                                     : hn::Set(d_, 1.0f);
        const auto run =
            find_run(d_, shading, fragments_, record, covered.span(d_, i),
                     coverage_.columns(covered.at(i)), coverage_.rows(covered.at(i)), slant);
        return shading.color(d_, fragments_, record, run);
    }

    const TetFragments& fragments_;
    const TetTile& tile_;
    Tag d_;
    TetCoverage coverage_;
};

}  // namespace lamina::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
