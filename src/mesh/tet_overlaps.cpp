// SPDX-License-Identifier: Apache-2.0
// Finds overlapping tets: a tree of boxes proposes pairs, and the separating axis theorem decides.
//
// Two tets have no inner point in common if and only if a plane separates them that is the plane of
// a face, or is parallel to an edge of each. Planes of faces are tested exactly, so tets that share
// a face, an edge, or a corner in a mesh's usual places are never listed.
//
// Only pairs of which one tet has an open face are proposed. Steps lead from these to all others:
// a step replaces one tet of a pair by its neighbour, or both by a neighbour each. Proof: let S and
// T overlap. From a common inner point walk along a line that meets no edge and no corner of the
// mesh, in S and in T, and from each across shared faces to its neighbours. Where the line leaves
// one of the two, or both at once, the tets that it is in behind that place overlap: a step. They
// never become one, because across the face by which a line enters a tet lies only one other tet.
// The mesh is bounded, so the line comes to an open face of one of the two, at a point of the other
// one. That pair is proposed.
#include "mesh/tet_overlaps.h"

#include <atomic>
#include <optional>
#include <unordered_set>

#include <glm/vector_relational.hpp>
#include "base/parallel.h"
#include "mesh/face_tree.h"

namespace lamina {
namespace {

constexpr std::int64_t tets_per_task = 1024;

// Limit on the work of finding pairs, per tet with an open face on average, and for few of these
// that all overlap. Looking at a node of the tree or at an entry of a leaf is 1, testing a pair of
// tets 8. In Delaunay meshes with many open faces a tet takes some 1500: 460 entries, 98 tests, and
// the nodes above them.
constexpr std::int64_t most_work_per_tet = 4000, most_work_of_few = 10'000'000, work_of_test = 8;

// Distance, as a share of the far end's, within which two places of entry are one (tie_distance()).
constexpr double tie_share = 1e-10;

struct PlacedTet {
    std::array<glm::dvec3, 4> corners;
    Tet places;
};

struct FacePlane {
    Triangle corners;
    RoundedPlane plane;
};

std::array<FacePlane, 4> faces_of(const PlacedTet& tet) {
    std::array<FacePlane, 4> found;
    for (std::size_t face = 0; face < 4; ++face) {
        const auto [i, j, k] = corners_of_face({0, 1, 2, 3}, face);
        const Triangle corners{tet.corners[i], tet.corners[j], tet.corners[k]};
        found[face] = {corners, RoundedPlane(corners[1] - corners[0], corners[2] - corners[0])};
    }
    return found;
}

// Tells whether one of a tet's faces separates it from another tet, which may touch it. Exact.
bool some_separates(const std::array<FacePlane, 4>& faces, const PlacedTet& other) {
    return std::ranges::any_of(faces, [&](const FacePlane& face) {
        return std::ranges::all_of(other.corners, [&](const glm::dvec3& point) {
            return side_of(face.corners, face.plane, point) >= 0;
        });
    });
}

// Tells whether the plane through `base` that is parallel to two edges surely has tet `a` on its
// inner side and `b` on its outer side, or the other way round, apart from the corners marked as
// lying on it exactly. `on_a`, `on_b`: bits of the corners.
bool surely_apart(const glm::dvec3& base, const RoundedPlane& plane, const PlacedTet& a,
                  unsigned on_a, const PlacedTet& b, unsigned on_b) {
    const auto side = [&](const PlacedTet& tet, unsigned on) {
        int common = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if ((on >> i & 1) != 0) continue;
            const int sign = plane.sign(tet.corners[i] - base);
            if (sign == 0 || sign == -common) return 0;
            common = sign;
        }
        return common;
    };
    const int of_a = side(a, on_a);
    return of_a != 0 && side(b, on_b) == -of_a;
}

// Tells whether a plane parallel to an edge of each tet surely separates them. If the tets share a
// corner, planes through it suffice, and it and its edges' other ends lie on these exactly.
bool edges_separate(const PlacedTet& a, const PlacedTet& b) {
    for (std::size_t i = 0; i < 4; ++i) {
        const auto same = std::ranges::find(b.places, a.places[i]);
        if (same == b.places.end()) continue;
        const auto j = static_cast<std::size_t>(same - b.places.begin());
        for (std::size_t p = 0; p < 4; ++p) {
            for (std::size_t q = 0; q < 4; ++q) {
                if (p == i || q == j) continue;
                const RoundedPlane plane(a.corners[p] - a.corners[i], b.corners[q] - a.corners[i]);
                if (surely_apart(a.corners[i], plane, a, 1U << i | 1U << p, b, 1U << j | 1U << q))
                    return true;
            }
        }
        return false;
    }
    for (const auto& [i, p] : tet_edges) {
        for (const auto& [j, q] : tet_edges) {
            // The plane through the edge of `a`; a corner of `b` on it would only touch it.
            const RoundedPlane plane(a.corners[p] - a.corners[i], b.corners[q] - b.corners[j]);
            if (surely_apart(a.corners[i], plane, a, 1U << i | 1U << p, b, 0)) return true;
        }
    }
    return false;
}

// Tells whether boxes have an inner point in common.
bool boxes_meet(const FaceTree::Box& a, const FaceTree::Box& b) {
    return glm::all(glm::lessThan(a.min, b.max)) && glm::all(glm::lessThan(b.min, a.max));
}

// Tells whether boxes have a point in common.
bool boxes_touch(const FaceTree::Box& a, const FaceTree::Box& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

// Marks the cells of a grid that open faces may touch, so that most tets that touch none are known
// at once. Rounding keeps the order of numbers, so boxes that touch have a cell in common.
class TouchedCells {
  public:
    // `boxes`: around the open faces.
    TouchedCells(const TetMesh& mesh, std::span<const FaceTree::Box> boxes)
        : low_(mesh.bounds().min), cells_(mesh.points().size()) {
        glm::dvec3 mean(0);
        for (const FaceTree::Box& box : boxes)
            mean += (box.max - box.min) / static_cast<double>(boxes.size());
        for (int axis = 0; axis < 3; ++axis) {
            const double extent = mesh.bounds().max[axis] - low_[axis];
            const double cells = std::min(extent / mean[axis], static_cast<double>(most_cells));
            if (!(cells > 1)) continue;  // false for NaN
            count_[axis] = static_cast<std::int32_t>(cells);
            scale_[axis] = count_[axis] / extent;
        }
        parallel_for(std::ssize(cells_), points_per_task,
                     [&](std::int64_t point) { cells_[point] = cell_of(mesh.points()[point]); });
        mark(boxes);
    }

    // Tells whether a tet may touch an open face. It may if it is so large that looking takes long.
    bool may_touch(const Tet& tet) const {
        Cell first = cells_[tet[0]], last = first;
        for (std::size_t i = 1; i < 4; ++i) {
            const Cell& cell = cells_[tet[i]];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                first[axis] = std::min(first[axis], cell[axis]);
                last[axis] = std::max(last[axis], cell[axis]);
            }
        }
        std::int64_t cells = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) cells *= last[axis] - first[axis] + 1;
        if (cells > most_cells_of_tet) return true;
        bool touches = false;
        for_cells(first, last, [&](std::size_t cell) { return !(touches = marked_[cell] != 0); });
        return touches;
    }

  private:
    using Cell = std::array<std::uint8_t, 4>;  // of each axis; the last is not used

    static constexpr int most_cells = 128;  // of an axis: 2 MB in all
    static constexpr std::int64_t most_cells_of_tet = 512, most_marks_per_box = 64,
                                  points_per_task = 4096;

    Cell cell_of(const glm::dvec3& place) const {
        Cell cell{};
        for (int axis = 0; axis < 3; ++axis) {
            const double at = (place[axis] - low_[axis]) * scale_[axis];
            // Points that no tet uses may be NaN or anywhere.
            cell[axis] = static_cast<std::uint8_t>(at > 0 ? std::min(at, count_[axis] - 1.0) : 0);
        }
        return cell;
    }

    // Marks the cells of all boxes; all cells at once, if boxes are so large that this takes long.
    void mark(std::span<const FaceTree::Box> boxes) {
        marked_.resize(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2]);
        std::int64_t left = most_marks_per_box * std::ssize(boxes) + std::ssize(marked_);
        for (const FaceTree::Box& box : boxes) {
            for_cells(cell_of(box.min), cell_of(box.max), [&](std::size_t cell) {
                marked_[cell] = 1;
                return --left > 0;
            });
        }
        if (left <= 0) std::ranges::fill(marked_, 1);
    }

    // Calls visit(cell) for the cells from first to last along each axis, until it returns false.
    template <typename Visit>
    void for_cells(const Cell& first, const Cell& last, const Visit& visit) const {
        for (int z = first[2]; z <= last[2]; ++z) {
            for (int y = first[1]; y <= last[1]; ++y) {
                const auto row = static_cast<std::size_t>((z * count_[1] + y) * count_[0]);
                for (std::size_t x = first[0]; x <= last[0]; ++x)
                    if (!visit(row + x)) return;
            }
        }
    }

    glm::dvec3 low_, scale_{0};
    std::array<int, 3> count_{1, 1, 1};
    std::vector<Cell> cells_;  // of each point
    std::vector<std::uint8_t> marked_;
};

// Implements find_overlaps(). Tets without volume count as removed, and their neighbours' faces as
// open.
class OverlapSearch {
  public:
    OverlapSearch(const TetMesh& mesh, std::size_t most)
        : mesh_(mesh), most_(most), kinds_(mesh.tets().size(), Kind::inner) {
        for (const TetFace& face : mesh.open_faces()) kinds_[face.tet] = Kind::open;
        for (const std::int32_t flat : mesh.flat_tets()) {
            for (const std::int32_t neighbor : mesh.neighbors()[flat])
                if (neighbor != TetMesh::no_neighbor) kinds_[neighbor] = Kind::open;
        }
        for (const std::int32_t flat : mesh.flat_tets()) kinds_[flat] = Kind::flat;
        list_open();
    }

    TetOverlaps find() {
        TetOverlaps found;
        found.complete = propose() && follow();
        if (found.complete) found.pairs = std::move(pairs_);
        std::sort(found.pairs.begin(), found.pairs.end());
        return found;
    }

  private:
    enum class Kind : std::uint8_t { inner, open, flat };

    PlacedTet placed(std::int32_t tet) const {
        return {mesh_.corners(tet), mesh_.place(mesh_.tets()[tet])};
    }
    bool neighbors(std::int32_t a, std::int32_t b) const {
        return std::ranges::find(mesh_.neighbors()[a], b) != mesh_.neighbors()[a].end();
    }

    // Lists the tets with open faces, and boxes around each and around its open faces.
    void list_open() {
        for (std::size_t tet = 0; tet < kinds_.size(); ++tet) {
            if (kinds_[tet] == Kind::open) open_.push_back(static_cast<std::int32_t>(tet));
        }
        boxes_.resize(open_.size());
        open_boxes_.resize(open_.size());
        parallel_for(std::ssize(open_), tets_per_task, [&](std::int64_t index) {
            const std::int32_t tet = open_[index];
            boxes_[index] = FaceTree::box_around(mesh_.corners(tet));
            open_boxes_[index] = around_open_faces(tet);
        });
    }
    FaceTree::Box around_open_faces(std::int32_t tet) const {
        FaceTree::Box box = FaceTree::nothing();
        for (std::int32_t face = 0; face < 4; ++face) {
            const std::int32_t across = mesh_.neighbors()[tet][face];
            if (across != TetMesh::no_neighbor && kinds_[across] != Kind::flat) continue;
            box.add(FaceTree::box_around(mesh_.corners({tet, face})));
        }
        return box;
    }

    // Finds the pairs of which one tet has an open face. Returns false if there are too many.
    bool propose() {
        const FaceTree tree(open_boxes_);
        const TouchedCells near(mesh_, open_boxes_);
        const auto count = std::ssize(kinds_);
        const std::int64_t tasks = (count + tets_per_task - 1) / tets_per_task;
        std::vector<std::vector<TetPair>> found(static_cast<std::size_t>(tasks));
        std::atomic<std::int64_t> left{
            std::max(most_work_of_few, most_work_per_tet * std::ssize(open_))};
        std::atomic<std::size_t> total{0};
        parallel_for(tasks, 1, [&](std::int64_t task) {
            const std::int64_t end = std::min(count, (task + 1) * tets_per_task);
            for (std::int64_t tet = task * tets_per_task; tet < end; ++tet) {
                if (kinds_[tet] == Kind::flat || !near.may_touch(mesh_.tets()[tet])) continue;
                if (left < 0 || total > most_) return;
                const std::size_t before = found[task].size();
                left -= propose_with(static_cast<std::int32_t>(tet), tree, found[task]);
                total += found[task].size() - before;
            }
        });
        if (left < 0 || total > most_) return false;
        for (const auto& mine : found) pairs_.insert(pairs_.end(), mine.begin(), mine.end());
        return true;
    }

    // Finds the pairs of a tet and one with an open face near it. Returns the work that it took.
    std::int64_t propose_with(std::int32_t tet, const FaceTree& tree,
                              std::vector<TetPair>& found) const {
        const PlacedTet here = placed(tet);
        const FaceTree::Box box = FaceTree::box_around(here.corners);
        const bool open = kinds_[tet] == Kind::open;
        const FaceTree::Box open_box = open ? around_open_faces(tet) : FaceTree::nothing();
        std::optional<std::array<FacePlane, 4>> faces;
        std::int64_t work = 0;
        const auto may_touch = [&](const FaceTree::Box& node) {
            ++work;
            return boxes_touch(node, box);
        };
        tree.visit(may_touch, [&](std::int32_t index) {
            ++work;
            const std::int32_t other = open_[index];
            if (other == tet || !boxes_touch(open_boxes_[index], box) ||
                !boxes_meet(boxes_[index], box) || neighbors(tet, other))
                return;
            // The smaller one of two tets with open faces near each other finds both.
            if (open && other < tet && boxes_touch(open_box, boxes_[index])) return;
            work += work_of_test;
            if (!faces) faces = faces_of(here);
            if (overlap(here, *faces, placed(other))) found.push_back(std::minmax(tet, other));
        });
        return work;
    }

    // Steps from pair to pair. Returns false if there are too many.
    bool follow() {
        std::unordered_set<std::uint64_t> known;
        const auto is_new = [&](const TetPair& pair) {
            return known
                .insert(static_cast<std::uint64_t>(pair.first) << 32 |
                        static_cast<std::uint32_t>(pair.second))
                .second;
        };
        for (const TetPair& pair : pairs_) is_new(pair);
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (pairs_.size() > most_) return false;
            check_interrupt();
            const auto [first, second] = pairs_[i];
            for (const std::int32_t a : reached_from(first)) {
                for (const std::int32_t b : reached_from(second)) {
                    if (a == TetMesh::no_neighbor || b == TetMesh::no_neighbor || a == b ||
                        kinds_[a] == Kind::flat || kinds_[b] == Kind::flat || neighbors(a, b))
                        continue;
                    const TetPair pair = std::minmax(a, b);
                    if (is_new(pair) && overlap(pair)) pairs_.push_back(pair);
                }
            }
        }
        return true;
    }

    // Returns a tet and its neighbours.
    std::array<std::int32_t, 5> reached_from(std::int32_t tet) const {
        const auto& [a, b, c, d] = mesh_.neighbors()[tet];
        return {tet, a, b, c, d};
    }

    // Tells whether two tets overlap (the file's head). `faces`: those of `a`.
    static bool overlap(const PlacedTet& a, const std::array<FacePlane, 4>& faces,
                        const PlacedTet& b) {
        return !some_separates(faces, b) && !some_separates(faces_of(b), a) &&
               !edges_separate(a, b);
    }
    bool overlap(const TetPair& pair) const {
        const PlacedTet first = placed(pair.first);
        return overlap(first, faces_of(first), placed(pair.second));
    }

    const TetMesh& mesh_;
    std::size_t most_;
    std::vector<Kind> kinds_;
    // Tets with open faces, the box around each, and around its open faces.
    std::vector<std::int32_t> open_;
    std::vector<FaceTree::Box> boxes_, open_boxes_;
    std::vector<TetPair> pairs_;
};

}  // namespace

std::vector<std::int32_t> tets_of(std::span<const TetPair> pairs) {
    std::vector<std::int32_t> tets;
    for (const auto& [a, b] : pairs) tets.insert(tets.end(), {a, b});
    std::sort(tets.begin(), tets.end());
    tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
    return tets;
}

TetOverlaps find_overlaps(const TetMesh& mesh, std::size_t most) {
    return OverlapSearch(mesh, most).find();
}

double tie_distance(const TetMesh& mesh, const Eye& eye) {
    const auto& [low, high] = mesh.bounds();
    if (eye.at_infinity) return tie_share * glm::length(high - low);
    return tie_share *
           glm::length(glm::max(glm::abs(low - eye.position), glm::abs(high - eye.position)));
}

EntryRule entry_rule(const TetMesh& mesh, const Eye& eye, const glm::dvec3& direction) {
    return {eye.at_infinity ? -INFINITY : 0, tie_distance(mesh, eye) / glm::length(direction)};
}

}  // namespace lamina
