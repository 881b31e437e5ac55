// SPDX-License-Identifier: Apache-2.0
#include "visibility/farthest_first.h"

#include <algorithm>

#include "visibility/view_distance.h"

namespace lamina {
namespace {

// A tet's state: not met yet, or on the path with this many faces behind it, or drawn.
constexpr std::uint8_t unmet = 0, first_face = 1, drawn = 6;

}  // namespace

FarthestFirst::FarthestFirst(const TetMesh& mesh) : mesh_(mesh), next_face_(mesh.tets().size()) {
    starts_.reserve(mesh.open_faces().size());
}

void FarthestFirst::find_starts(const Eye& eye) {
    starts_.clear();
    for (const TetFace& face : mesh_.open_faces()) {
        const auto [a, b, c] = mesh_.corners(face);
        if (sign_as_seen(eye, a, b, c) < 0)
            starts_.push_back({view_distance(eye, (a + b + c) / 3.0), face.tet});
    }
    std::sort(starts_.begin(), starts_.end());
}

std::int64_t FarthestFirst::sort(const OrderGraph& graph, std::span<std::int32_t> order) {
    find_starts(graph.eye());
    std::fill(next_face_.begin(), next_face_.end(), unmet);
    drawn_ = 0;
    broken_ = 0;
    for (const Start& start : starts_) draw(graph, start.tet, order);
    // An eye inside the mesh has tets that no open face towards it leads to.
    for (std::size_t tet = 0; tet < order.size(); ++tet)
        draw(graph, static_cast<std::int32_t>(tet), order);
    return broken_;
}

void FarthestFirst::draw(const OrderGraph& graph, std::int32_t root,
                         std::span<std::int32_t> order) {
    if (next_face_[static_cast<std::size_t>(root)] != unmet) return;
    // The path grows from the end of `order`. Both fit, because no tet is drawn and on the path at
    // once.
    std::size_t top = order.size();
    order[--top] = root;
    next_face_[static_cast<std::size_t>(root)] = first_face;
    while (top < order.size()) {
        const std::int32_t tet = order[top];
        std::uint8_t& state = next_face_[static_cast<std::size_t>(tet)];
        const FaceSigns signs = graph.signs(tet);
        while (state < first_face + 4 && !(signs & farther_bit(state - first_face))) ++state;
        if (state == first_face + 4) {
            state = drawn;
            ++top;
            order[drawn_++] = tet;
            continue;
        }
        const auto face = static_cast<std::size_t>(state++ - first_face);
        const std::int32_t farther = mesh_.neighbors()[static_cast<std::size_t>(tet)][face];
        std::uint8_t& other = next_face_[static_cast<std::size_t>(farther)];
        if (other == unmet) {
            other = first_face;
            order[--top] = farther;
        } else if (other != drawn) {
            ++broken_;
        }
    }
}

}  // namespace lamina
