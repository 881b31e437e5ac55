// SPDX-License-Identifier: Apache-2.0
#include "slicing/cpu_slabs.h"

#undef LAMINA_TARGET_FILE
#define LAMINA_TARGET_FILE "slicing/cpu_cells.cpp"
#include "simd/foreach_target.h"

#include "slicing/cpu_cells-inl.h"

LAMINA_SIMD_BEGIN

template <bool lit>
void CellIntegrator<lit>::begin(const CpuBrickView& view, const PacketRays* packets,
                                std::size_t count, int slab) {
    view_ = &view;
    packets_ = count;
    for (std::size_t i = 0; i < count; ++i) {
        spans_[i] = span_from(packets[i], slab);
        walks_[i].begin(*slabs_.cells, view, packets[i], spans_[i], slabs_.light);
    }
}

template <bool lit>
void CellIntegrator<lit>::next(RaySum* sums) {
    walk();
    count_ += static_cast<std::int64_t>(segments_.count);
    if (segments_.count > 0) {
        set_cubics();
        with_lookup(*slabs_.transfer, [&](auto kind) LAMINA_LAMBDA {
            if (slabs_.transfer->bend[0].empty()) {
                integrate<decltype(kind)::value, false>(*slabs_.transfer);
            } else {
                integrate<decltype(kind)::value, true>(*slabs_.transfer);
            }
        });
    }
    if (colored_) {
        sum_segments<true>(sums);
    } else {
        sum_segments<false>(sums);
    }
}

template void CellIntegrator<false>::begin(const CpuBrickView&, const PacketRays*, std::size_t,
                                           int);
template void CellIntegrator<false>::next(RaySum*);
template void CellIntegrator<true>::begin(const CpuBrickView&, const PacketRays*, std::size_t, int);
template void CellIntegrator<true>::next(RaySum*);

LAMINA_SIMD_END
