// SPDX-License-Identifier: Apache-2.0
// OpenFaceConstraints::find(), for each eye:
//   1. For each open face: find whether it is an exit or an entry, and the box that it is seen in.
//   2. For each node of the tree: find the boxes around the entries below it.
//   3. For each exit, in parallel: search the tree for entries that may be seen through it, and
//      decide exactly for each of these (SeenTriangle::shows()).
#include "visibility/open_face_constraints.h"

#include <atomic>

#include <glm/mat3x3.hpp>
#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"
#include "visibility/order_graph.h"

namespace lamina {
namespace {

std::size_t after(std::size_t corner) {
    return corner == 2 ? 0 : corner + 1;
}

// Returns the solid angle of a triangle seen from 0 (Van Oosterom and Strackee, The solid angle of
// a plane triangle, 1983, equation 8).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double determinant = glm::dot(a, glm::cross(b, c));
    const double rest =
        la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la;
    return 2 * std::abs(std::atan2(std::abs(determinant), rest));
}

double area(const Eye& eye, const CutTriangle& polygon) {
    double sum = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
        const glm::dvec3 &a = polygon.corners[0], &b = polygon.corners[i - 1],
                         &c = polygon.corners[i];
        sum +=
            eye.at_infinity
                ? 0.5 * std::abs(glm::dot(glm::normalize(eye.position), glm::cross(b - a, c - a)))
                : solid_angle(a, b, c);
    }
    return sum;
}

// Returns a triangle relative to the eye; if that is at infinity, to `origin`.
CutTriangle from_eye(const Eye& eye, const Triangle& triangle, const glm::dvec3& origin) {
    CutTriangle polygon;
    for (const glm::dvec3& corner : triangle)
        polygon.add(corner - (eye.at_infinity ? origin : eye.position));
    return polygon;
}

// Makes boxes around triangles as seen from the eye: two axes across the rays, one along them, for
// may_show(). A triangle that is not clearly in front of the eye gets an infinite box.
class SeenBoxes {
  public:
    // Makes boxes for the side of the eye towards `center`.
    SeenBoxes(const Eye& eye, const glm::dvec3& center);

    FaceTree::Box of(const Triangle& triangle) const;

  private:
    bool at_infinity_;
    glm::dvec3 origin_;
    glm::dmat3 axes_;  // columns: two across the rays, one along them
};

// Tells whether some ray may meet a triangle in `exit` and then one in `entry`.
inline bool may_show(const FaceTree::Box& exit, const FaceTree::Box& entry) {
    return entry.max.x >= exit.min.x && entry.min.x <= exit.max.x && entry.max.y >= exit.min.y &&
           entry.min.y <= exit.max.y && entry.max.z >= exit.min.z;
}

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// Largest ratio of distance (1-norm) and depth of a point that counts as in front of the eye.
constexpr double widest = 1e3;

SeenBoxes::SeenBoxes(const Eye& eye, const glm::dvec3& center)
    : at_infinity_(eye.at_infinity), origin_(eye.at_infinity ? center : eye.position) {
    const glm::dvec3 towards = eye.at_infinity ? eye.position : center - eye.position;
    const glm::dvec3 size = glm::abs(towards);
    const double largest = std::max({size.x, size.y, size.z});
    const glm::dvec3 along = largest > 0 ? glm::normalize(towards / largest) : glm::dvec3(0, 0, 1);
    const glm::dvec3 other = size.x < largest ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(other, along));
    axes_ = {across, glm::cross(along, across), along};
}

// `slack` bounds rounding: a coordinate is off by at most 4 epsilon of the distance (1-norm; axes
// may be not quite orthogonal), a quotient by the errors of both numbers as a share of the depth.
FaceTree::Box SeenBoxes::of(const Triangle& triangle) const {
    FaceTree::Box box = FaceTree::nothing();
    for (const glm::dvec3& corner : triangle) {
        const glm::dvec3 from = corner - origin_;
        const double distance = norm1(from);
        glm::dvec3 seen(glm::dot(from, axes_[0]), glm::dot(from, axes_[1]),
                        glm::dot(from, axes_[2]));
        glm::dvec3 slack(8 * epsilon * distance);
        if (!at_infinity_) {
            if (!(seen.z * widest > distance)) return {glm::dvec3(-INFINITY), glm::dvec3(INFINITY)};
            const double share = distance / seen.z;
            seen.x /= seen.z;
            seen.y /= seen.z;
            slack.x = slack.y = 16 * epsilon * share * (1 + share);
        }
        box.add({seen - slack, seen + slack});
    }
    return box;
}

// Limits how many other faces are examined for each face, on average. Real meshes need far fewer.
constexpr std::size_t max_tests_per_face = 100;

// Finds gap_faces(): the open faces that are not outermost. A face is outermost if all of the mesh
// lies inside of its plane, apart from faces in the plane that look the same way.
class Search {
  public:
    explicit Search(const TetMesh& mesh)
        : mesh_(mesh),
          tree_(mesh, mesh.open_faces()),
          bounds_{mesh.bounds().min, mesh.bounds().max},
          left_(max_tests_per_face * mesh.open_faces().size()),
          outside_(mesh.points()[mesh.tets()[0][0]]) {}

    std::vector<std::int32_t> find() {
        std::vector<char> outermost(mesh_.open_faces().size());
        std::vector<std::int32_t> found;
        for (std::size_t i = 0; i < outermost.size(); ++i) {
            if (outermost[i]) continue;
            check_interrupt();
            const auto face = static_cast<std::int32_t>(i);
            if (!is_outermost(face)) {
                found.push_back(face);
                continue;
            }
            // One face of each flat side of the mesh is tested for all.
            for (const std::int32_t other : in_plane_) outermost[other] = true;
        }
        return found;
    }

  private:
    Triangle triangle(std::int32_t face) const { return mesh_.corners(mesh_.open_faces()[face]); }

    // Tells whether a face is outermost. If so, `in_plane_` gets all other faces of its plane.
    bool is_outermost(std::int32_t face) {
        const Triangle corners = triangle(face);
        const RoundedPlane plane(corners[1] - corners[0], corners[2] - corners[0]);
        in_plane_.clear();
        // A point outside of the last tested face is mostly outside of its neighbours, too.
        if (side_of(corners, plane, outside_) > 0) return false;
        const PlaneSide side(plane, corners[0], bounds_);
        bool outermost = true;
        const auto look_at = [&](std::int32_t other) {
            if (!outermost || other == face) return;
            if (left_ == 0) {
                outermost = false;
                return;
            }
            --left_;
            const Triangle there = triangle(other);
            if (!side.reaches(there)) return;
            bool in_plane = true;
            for (const glm::dvec3& point : there) {
                const int sign = side_of(corners, plane, point);
                in_plane &= sign == 0;
                if (sign <= 0) continue;
                outside_ = point;
                outermost = false;
                return;
            }
            if (!in_plane) return;
            const RoundedPlane touching(there[1] - there[0], there[2] - there[0]);
            if (is_sure(plane) && is_sure(touching) &&
                glm::dot(plane.normal, touching.normal) > 0) {
                in_plane_.push_back(other);
            } else {
                outermost = false;
            }
        };
        tree_.visit([&](const FaceTree::Box& box) { return outermost && side.reaches(box); },
                    look_at);
        return outermost;
    }

    // Tells whether rounding leaves the direction of the plane's normal certain.
    static bool is_sure(const RoundedPlane& plane) { return norm1(plane.normal) > plane.error; }

    const TetMesh& mesh_;
    FaceTree tree_;
    FaceTree::Box bounds_;
    std::size_t left_;    // number of faces that may still be examined
    glm::dvec3 outside_;  // a point outside of the last face that was not outermost
    std::vector<std::int32_t> in_plane_;
};

constexpr std::int64_t faces_per_task = 256;
constexpr std::size_t exits_per_task = 32;       // number of exits that one task searches from
constexpr std::size_t most_pairs = 10'000'000;   // some seconds, and 200 MB with the order's lists
constexpr std::size_t most_looks = 200'000'000;  // entries that all searches look at

std::vector<TetFace> faces_of(const TetMesh& mesh, std::span<const std::int32_t> open_faces) {
    std::vector<TetFace> faces;
    faces.reserve(open_faces.size());
    for (const std::int32_t face : open_faces) faces.push_back(mesh.open_faces()[face]);
    return faces;
}

}  // namespace

SeenTriangle::SeenTriangle(const Eye& eye, const Triangle& corners) : corners_(corners) {
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& from = corners[i];
        edges_[i] = RoundedPlane(eye.at_infinity ? eye.position : from - eye.position,
                                 corners[after(i)] - from);
    }
    face_ = RoundedPlane(corners[1] - corners[0], corners[2] - corners[0]);
    sign_ = edge_sign(eye, 0, corners[2]);
}

int SeenTriangle::edge_sign(const Eye& eye, std::size_t corner, const glm::dvec3& point) const {
    const glm::dvec3 &from = corners_[corner], &to = corners_[after(corner)];
    if (const int sign = edges_[corner].sign(point - from)) return sign;
    // Shortcut: most triangles that meet share a corner.
    if (point == from || point == to) return 0;
    return sign_as_seen(eye, from, to, point);
}

// Returns 1 if all corners of `other` are on this plane or outside, -1 if on it or inside, else 0.
int SeenTriangle::all_on_one_side(const SeenTriangle& other) const {
    bool outside = false, inside = false;
    for (const glm::dvec3& point : other.corners_) {
        const int sign = side_of(corners_, face_, point);
        outside |= sign > 0;
        inside |= sign < 0;
    }
    return !inside ? 1 : !outside ? -1 : 0;
}

// Tells whether all rays through both triangles surely lie in one open half-space.
bool SeenTriangle::sees_ahead(const Eye& eye, const SeenTriangle& other) const {
    if (eye.at_infinity) return true;
    return std::all_of(other.corners_.begin(), other.corners_.end(), [&](const glm::dvec3& point) {
        return face_.sign(point - eye.position) == sign_;
    });
}

bool SeenTriangle::separated_by_edge(const Eye& eye, const SeenTriangle& other) const {
    for (std::size_t edge = 0; edge < 3; ++edge) {
        // Rounded values come first: a corner that is surely on the inner side decides.
        std::array<int, 3> signs;
        for (std::size_t i = 0; i < 3; ++i)
            signs[i] = sign_ * edges_[edge].sign(other.corners_[i] - corners_[edge]);
        if (signs[0] > 0 || signs[1] > 0 || signs[2] > 0) continue;
        const auto beyond = [&](std::size_t i) {
            return signs[i] < 0 || sign_ * edge_sign(eye, edge, other.corners_[i]) <= 0;
        };
        if (beyond(0) && beyond(1) && beyond(2)) return true;
    }
    return false;
}

// Tells whether the triangles do not overlap as seen from the eye. Two triangles in a plane have no
// inner point in common if and only if a line through an edge of one separates them (separating
// axis theorem). The same holds for the pyramids of rays if all rays lie in one half-space. If they
// do not, planes through the eye and one corner of each must be tested, too.
bool SeenTriangle::apart(const Eye& eye, const SeenTriangle& entry) const {
    if (separated_by_edge(eye, entry) || entry.separated_by_edge(eye, *this)) return true;
    if (sees_ahead(eye, entry)) return false;
    const Triangle &p = corners_, &q = entry.corners_;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const auto sign = [&](const glm::dvec3& point) {
                return sign_as_seen(eye, p[i], q[j], point);
            };
            const int p1 = sign(p[after(i)]), p2 = sign(p[after(after(i))]);
            const int q1 = sign(q[after(j)]), q2 = sign(q[after(after(j))]);
            if (p1 == 0 && p2 == 0 && q1 == 0 && q2 == 0) continue;
            if (p1 >= 0 && p2 >= 0 && q1 <= 0 && q2 <= 0) return true;
            if (p1 <= 0 && p2 <= 0 && q1 >= 0 && q2 >= 0) return true;
        }
    }
    return false;
}

bool SeenTriangle::shows(const Eye& eye, const SeenTriangle& entry) const {
    // If a triangle lies on one side of the other's plane, this side decides which is in front.
    const auto surely_before = [&](const glm::dvec3& point) {
        return face_.sign(point - corners_[0]) < 0;
    };
    const Triangle& q = entry.corners_;
    if (surely_before(q[0]) && surely_before(q[1]) && surely_before(q[2])) return false;
    if (apart(eye, entry)) return false;
    const int of_entry = all_on_one_side(entry);
    if (of_entry < 0) return false;
    if (of_entry > 0) return true;
    const int of_exit = entry.all_on_one_side(*this);
    return of_exit != 0 ? of_exit > 0 : overlap_is_behind(eye, entry);
}

// Tells whether some part of an entry that intersects the exit is seen behind it: a corner of their
// overlap, which is a corner of one triangle inside the other or a crossing of edges.
bool SeenTriangle::overlap_is_behind(const Eye& eye, const SeenTriangle& entry) const {
    const auto inside = [&](const SeenTriangle& triangle, const glm::dvec3& point) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle.edge_sign(eye, i, point) * triangle.sign_ < 0) return false;
        }
        return true;
    };
    for (const glm::dvec3& point : entry.corners_) {
        if (side_of(corners_, face_, point) > 0 && inside(*this, point)) return true;
    }
    for (const glm::dvec3& point : corners_) {
        if (side_of(entry.corners_, entry.face_, point) > 0 && inside(entry, point)) return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = corners_[i], &b = corners_[after(i)];
        for (std::size_t j = 0; j < 3; ++j) {
            const glm::dvec3 &c = entry.corners_[j], &d = entry.corners_[after(j)];
            const int side_c = edge_sign(eye, i, c);
            // Edges cross if, as seen from the eye, each has its ends on both sides of the other,
            // in opposite senses: if c -> d passes a -> b to one side, a -> b passes to the other.
            if (side_c == 0 || edge_sign(eye, i, d) != -side_c) continue;
            if (entry.edge_sign(eye, j, a) != -side_c || entry.edge_sign(eye, j, b) != side_c)
                continue;
            if (side_c * orientation(a, b, c, d) > 0) return true;
        }
    }
    return false;
}

SeenThrough::SeenThrough(const SeenTriangle& exit, const FaceTree::Box& bounds) {
    sides_[0] = PlaneSide(exit.face_, exit.corners_[0], bounds);
    for (std::size_t i = 0; i < 3; ++i)
        sides_[i + 1] = PlaneSide(exit.edges_[i], exit.corners_[i], bounds);
}

double seen_area(const Eye& eye, const Triangle& triangle) {
    return area(eye, from_eye(eye, triangle, triangle[0]));
}

CutTriangle part_behind(const CutTriangle& exit, const CutTriangle& entry, double slack) {
    const glm::dvec3& first = exit.corners[0];
    const glm::dvec3 outwards = glm::cross(exit.corners[1] - first, exit.corners[2] - first);
    const double least = -slack * glm::length(outwards);
    return cut(entry, [&](const glm::dvec3& c) { return glm::dot(outwards, c - first) - least; });
}

double seen_overlap(const Eye& eye, const Triangle& exit, const Triangle& entry, double in_front) {
    const CutTriangle window = from_eye(eye, exit, exit[0]);
    CutTriangle seen = from_eye(eye, entry, exit[0]);
    if (std::isfinite(in_front)) seen = part_behind(window, seen, in_front);
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = window.corners[i], &b = window.corners[(i + 1) % 3];
        const glm::dvec3 normal = glm::cross(eye.at_infinity ? eye.position : a, b - a);
        const double offset = glm::dot(normal, a);
        seen = cut(seen, [&](const glm::dvec3& c) { return glm::dot(normal, c) - offset; });
    }
    return area(eye, seen);
}

std::vector<std::int32_t> gap_faces(const TetMesh& mesh) {
    return Search(mesh).find();
}

OpenFaceConstraints::OpenFaceConstraints(const TetMesh& mesh)
    : mesh_(mesh),
      open_faces_(gap_faces(mesh)),
      tree_(mesh, faces_of(mesh, open_faces_)),
      bounds_{mesh.bounds().min, mesh.bounds().max},
      boxes_(tree_.node_count()),
      seen_boxes_(open_faces_.size()),
      seen_(open_faces_.size()),
      signs_(open_faces_.size()),
      found_((open_faces_.size() + exits_per_task - 1) / exits_per_task) {
    triangles_.reserve(open_faces_.size());
    for (const std::int32_t face : open_faces_)
        triangles_.push_back(mesh.corners(mesh.open_faces()[face]));
}

void OpenFaceConstraints::look_from(const Eye& eye) {
    const SeenBoxes seen_boxes(eye, 0.5 * bounds_.min + 0.5 * bounds_.max);
    parallel_for(std::ssize(seen_), faces_per_task, [&](std::size_t face) {
        seen_[face] = SeenTriangle(eye, triangles_[face]);
        seen_boxes_[face] = seen_boxes.of(triangles_[face]);
        signs_[face] = static_cast<std::int8_t>(seen_[face].sign());
    });
    const Boxes nothing{FaceTree::nothing(), FaceTree::nothing()};
    tree_.sum(std::span(boxes_), nothing, [&](std::int32_t index, Boxes& node) {
        const auto face = static_cast<std::size_t>(index);
        if (signs_[face] < 0) node.add({FaceTree::box_around(triangles_[face]), seen_boxes_[face]});
    });
}

std::span<const OpenFaceConstraint> OpenFaceConstraints::find(const Eye& eye) {
    look_from(eye);
    std::atomic<std::size_t> total{0}, looked_at{0};
    parallel_for(std::ssize(found_), 1, [&](std::size_t task) {
        found_[task].clear();
        const std::size_t end = std::min(seen_.size(), (task + 1) * exits_per_task);
        for (std::size_t face = task * exits_per_task; face < end; ++face) {
            if (signs_[face] <= 0) continue;
            const std::size_t before = found_[task].size();
            const std::size_t looked = find_from(face, eye, found_[task]);
            const std::size_t added = found_[task].size() - before;
            if (looked_at.fetch_add(looked, std::memory_order_relaxed) + looked > most_looks ||
                total.fetch_add(added, std::memory_order_relaxed) + added > most_pairs) {
                fail(
                    "more than {} pairs of open faces are seen one through the other, or {} may "
                    "be: the exact order is not for a mesh with so many gaps, mpvo is",
                    most_pairs, most_looks);
            }
        }
    });
    all_.clear();
    for (const auto& found : found_) all_.insert(all_.end(), found.begin(), found.end());
    return all_;
}

std::size_t OpenFaceConstraints::find_from(std::size_t index, const Eye& eye,
                                           std::vector<OpenFaceConstraint>& found) const {
    const SeenTriangle& exit = seen_[index];
    const FaceTree::Box& box = seen_boxes_[index];
    const SeenThrough behind(exit, bounds_);
    const auto tet_of = [&](std::int32_t open_face) { return mesh_.open_faces()[open_face].tet; };
    const std::int32_t face = open_faces_[index];
    std::size_t looked = 0;
    const auto reaches = [&](std::size_t node) {
        return may_show(box, boxes_[node].seen) && behind.reaches(boxes_[node].world);
    };
    tree_.visit_nodes(reaches, [&](std::int32_t other) {
        ++looked;
        const auto entry = static_cast<std::size_t>(other);
        if (signs_[entry] >= 0 || !may_show(box, seen_boxes_[entry]) ||
            !behind.reaches(triangles_[entry]))
            return;
        const std::int32_t entered = open_faces_[entry];
        if (tet_of(entered) != tet_of(face) && exit.shows(eye, seen_[entry]))
            found.push_back({face, entered});
    });
    return looked;
}

}  // namespace lamina
