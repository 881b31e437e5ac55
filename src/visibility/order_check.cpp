// SPDX-License-Identifier: Apache-2.0
#include "visibility/order_check.h"

#include <atomic>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "visibility/face_signs.h"

namespace lamina {
namespace {

std::vector<std::int32_t> places_in(std::span<const std::int32_t> order, std::size_t tets) {
    if (order.size() != tets)
        fail("an order has {} tets, expected the mesh's {}", order.size(), tets);
    std::vector<std::int32_t> places(tets, -1);
    for (std::size_t i = 0; i < tets; ++i) {
        const auto tet = static_cast<std::size_t>(order[i]);
        if (tet >= tets || places[tet] >= 0)
            fail("place {} of an order is tet {}, expected each of {} tets once", i, order[i],
                 tets);
        places[tet] = static_cast<std::int32_t>(i);
    }
    return places;
}

}  // namespace

std::int64_t face_violations(const TetMesh& mesh, const Eye& eye,
                             std::span<const std::int32_t> order) {
    const std::vector<std::int32_t> places = places_in(order, mesh.tets().size());
    const FaceSigner signer(mesh, eye);
    std::atomic<std::int64_t> violations{0};
    parallel_for(static_cast<std::int64_t>(order.size()), tets_per_task, [&](std::int64_t index) {
        const auto tet = static_cast<std::size_t>(index);
        const FaceSigns signs = signer.signs(tet);
        for (std::size_t face = 0; face < 4; ++face) {
            const std::int32_t other = mesh.neighbors()[tet][face];
            if (other == TetMesh::no_neighbor || !(signs & farther_bit(face))) continue;
            if (places[static_cast<std::size_t>(other)] > places[tet])
                violations.fetch_add(1, std::memory_order_relaxed);
        }
    });
    return violations;
}

}  // namespace lamina
