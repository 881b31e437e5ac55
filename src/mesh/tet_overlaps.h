// SPDX-License-Identifier: Apache-2.0
// Tets that overlap, and the order in which a ray meets them.
#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// The numbers of two tets, the smaller one first.
using TetPair = std::pair<std::int32_t, std::int32_t>;

// The tets of a mesh that overlap: two tets do if their insides have a point in common.
struct TetOverlaps {
    // All pairs, ascending. Pairs that touch up to rounding may be listed, too; neighbours and tets
    // without volume never are.
    std::vector<TetPair> pairs;
    // False: there are too many pairs, or too many tets that lie close together. `pairs` is empty.
    bool complete = true;
};

// Returns the tets of all pairs, ascending.
std::vector<std::int32_t> tets_of(std::span<const TetPair> pairs);

// Finds all overlaps of a mesh, unless there are more than `most` pairs. Pairs at open faces are
// found in parallel; steps from these to all others are serial. The time grows with the number of
// open faces and of overlaps, and hardly with that of tets.
TetOverlaps find_overlaps(const TetMesh& mesh, std::size_t most);

// The rule by which a ray composites the segments of overlapping tets, as whole segments one after
// the other: by ascending parameter at which it enters the tet, at `start` if the tet begins before
// that. Entries less than `tie` apart are one place; tets entered there follow by their numbers.
struct EntryRule {
    double start = -INFINITY;  // 0 in perspective, so that tets around the eye begin at the eye
    double tie = 0;
};

// Returns the distance, in world units, within which two places of entry are one. It is far above
// the rounding of places (4e-15 of the distance of the mesh's far end, or of its diagonal if the
// eye is at infinity, over a face's slope).
double tie_distance(const TetMesh& mesh, const Eye& eye);

// Returns the rule for a ray from the eye with the given direction.
EntryRule entry_rule(const TetMesh& mesh, const Eye& eye, const glm::dvec3& direction);

// Sorts items, one a tet on a ray, by the rule: entry(item) is the ray's parameter, tet(item) the
// number of its tet.
template <typename Item, typename Entry, typename Number>
void sort_by_entry(std::span<Item> items, const EntryRule& rule, const Entry& entry,
                   const Number& tet) {
    const auto begin = [&](const Item& item) {
        return std::max(std::invoke(entry, item), rule.start);
    };
    std::ranges::sort(items, [&](const Item& a, const Item& b) {
        return begin(a) != begin(b) ? begin(a) < begin(b)
                                    : std::invoke(tet, a) < std::invoke(tet, b);
    });
    for (std::size_t first = 0; first < items.size();) {
        std::size_t end = first + 1;
        while (end < items.size() && begin(items[end]) - begin(items[end - 1]) <= rule.tie) ++end;
        std::ranges::sort(items.subspan(first, end - first), {}, tet);
        first = end;
    }
}

}  // namespace lamina
