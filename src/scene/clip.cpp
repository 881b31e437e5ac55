// SPDX-License-Identifier: Apache-2.0
#include "scene/clip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/profile.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

// A corner counts as on a plane up to a share of the mesh's diagonal plus one of the coordinates,
// for their rounding. Renderers place faces to 9e-6 of an edge (docs/numerics.md, section 6).
constexpr double near_of_diagonal = 1e-10, near_of_coordinates = 0x1p-46;

// Numbers of the corners of a prism: triangles 0, 1, 2 and 3, 4, 5, joined by the edges 0-3, 1-4,
// 2-5. Seen from corner 3, the corners 0, 1, 2 go counter-clockwise.
using Prism = std::array<std::int32_t, 6>;

// Cuts a mesh by one half-space after the other:
//   1. Measure each point's distance from the plane: > 0 inside, 0 on it, < 0 outside.
//   2. Drop tets without a corner inside, and keep other tets without a corner outside.
//   3. Cut the others: one corner inside leaves a tet, two or three leave a prism of tets.
struct MeshCutter {
    MeshData& mesh;
    double diagonal;  // length of the diagonal of the mesh's bounding box
    // The first point at each point's place; empty if the mesh has no copies (TetMesh::places()).
    std::vector<std::int32_t> places;
    std::vector<double> distances = {};  // points' distances from the plane: > 0 inside, 0 on it
    // Numbers of the points at which edges are cut; the key holds the numbers of an edge's ends.
    std::unordered_map<std::uint64_t, std::int32_t> cut_points = {};
    // If there are copies: the first of the points at which edges between two places are cut.
    std::unordered_map<std::uint64_t, std::int32_t> cut_places = {};

    void cut(const HalfSpace& half) {
        measure_distances(half);
        if (std::ranges::none_of(distances, [](double d) { return d < 0; })) return;
        cut_points.clear();
        cut_places.clear();
        std::vector<Tet> tets = std::exchange(mesh.tets, {});
        mesh.tets.reserve(tets.size());
        for (const Tet& tet : tets) add_kept(tet);
    }

    void measure_distances(const HalfSpace& half) {
        const glm::dvec3 normal = glm::normalize(half.normal);
        distances.resize(mesh.points.size());
        parallel_for(static_cast<std::int64_t>(distances.size()), 4096, [&](std::int64_t i) {
            const glm::dvec3& point = mesh.points[static_cast<std::size_t>(i)];
            const double distance = glm::dot(normal, point - half.point);
            const double near = near_of_diagonal * diagonal +
                                near_of_coordinates * (norm1(point) + norm1(half.point));
            distances[static_cast<std::size_t>(i)] = std::abs(distance) <= near ? 0 : distance;
        });
    }

    double distance(std::int32_t point) const { return distances[static_cast<std::size_t>(point)]; }
    std::int32_t place(std::int32_t point) const {
        return places.empty() ? point : places[static_cast<std::size_t>(point)];
    }
    static std::uint64_t edge(std::int32_t a, std::int32_t b) {
        return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b);
    }

    void add_kept(const Tet& tet) {
        int inside = 0, outside = 0;
        for (const std::int32_t corner : tet) {
            inside += distance(corner) > 0;
            outside += distance(corner) < 0;
        }
        if (inside == 0) return;
        if (outside == 0) {
            mesh.tets.push_back(tet);
            return;
        }
        const Tet corners = inside_first(tet);
        const auto [a, b, c, d] = corners;
        switch (inside) {
            case 1:
                mesh.tets.push_back({a, cut_point(a, b), cut_point(a, c), cut_point(a, d)});
                break;
            case 2:
                add_prism(
                    {a, cut_point(a, c), cut_point(a, d), b, cut_point(b, c), cut_point(b, d)});
                break;
            default:
                add_prism({a, b, c, cut_point(a, d), cut_point(b, d), cut_point(c, d)});
        }
    }

    // Returns the corners, those inside first, in an even permutation: orientation stays.
    Tet inside_first(Tet tet) const {
        const auto outside = [&](std::int32_t corner) { return !(distance(corner) > 0); };
        bool odd = false;
        for (std::size_t last = 3; last > 0; --last) {
            for (std::size_t i = 0; i < last; ++i) {
                if (!outside(tet[i]) || outside(tet[i + 1])) continue;
                std::swap(tet[i], tet[i + 1]);
                odd = !odd;
            }
        }
        // Swapping two corners on the same side makes an odd permutation even.
        if (odd && outside(tet[0]) == outside(tet[1]))
            std::swap(tet[0], tet[1]);
        else if (odd)
            std::swap(tet[2], tet[3]);
        return tet;
    }

    // Returns the point at which an edge leaves the half-space. All tets at the edge share it, and
    // copies of the edge are cut at exactly the same place.
    std::int32_t cut_point(std::int32_t inside, std::int32_t outside) {
        if (distance(outside) == 0) return outside;
        const bool upwards = place(inside) < place(outside);
        const std::int32_t a = upwards ? inside : outside, b = upwards ? outside : inside;
        const auto number = static_cast<std::int32_t>(mesh.points.size());
        const auto [found, is_new] = cut_points.try_emplace(edge(a, b), number);
        if (!is_new) return found->second;
        if (!places.empty())
            places.push_back(
                cut_places.try_emplace(edge(place(a), place(b)), number).first->second);
        const double share = distance(a) / (distance(a) - distance(b));
        append_between(mesh.points, a, b, share);
        for (MeshScalar& scalar : mesh.point_scalars) append_between(scalar.values, a, b, share);
        return found->second;
    }

    // Appends the value between those of points a and b. Equal values give exactly that value.
    template <typename Value>
    static void append_between(std::vector<Value>& values, std::int32_t a, std::int32_t b,
                               double share) {
        const Value first = values[static_cast<std::size_t>(a)];
        values.push_back(first + share * (values[static_cast<std::size_t>(b)] - first));
    }

    // Adds a prism as tets. Each quadrilateral's diagonal begins at its corner of least place: so
    // neighbours agree (Dompierre et al. 1999). Leaves out tets with a corner twice (on the plane).
    void add_prism(const Prism& prism) {
        const auto rank = [&](std::int32_t point) { return place(point); };
        const auto least =
            static_cast<std::size_t>(std::ranges::min_element(prism, {}, rank) - prism.begin());
        static constexpr std::array<std::array<std::size_t, 6>, 6> from{{{0, 1, 2, 3, 4, 5},
                                                                         {1, 2, 0, 4, 5, 3},
                                                                         {2, 0, 1, 5, 3, 4},
                                                                         {3, 5, 4, 0, 2, 1},
                                                                         {4, 3, 5, 1, 0, 2},
                                                                         {5, 4, 3, 2, 1, 0}}};
        const auto corner = [&](std::size_t i) { return prism[from[least][i]]; };
        const auto at = [&](std::size_t i) { return place(corner(i)); };
        if (std::min(at(1), at(5)) < std::min(at(2), at(4))) {
            add_tet({corner(0), corner(1), corner(2), corner(5)});
            add_tet({corner(0), corner(1), corner(5), corner(4)});
        } else {
            add_tet({corner(0), corner(1), corner(2), corner(4)});
            add_tet({corner(0), corner(4), corner(2), corner(5)});
        }
        add_tet({corner(0), corner(4), corner(5), corner(3)});
    }

    void add_tet(const Tet& tet) {
        Tet sorted = tet;
        std::ranges::sort(sorted);
        if (std::ranges::adjacent_find(sorted) == sorted.end()) mesh.tets.push_back(tet);
    }
};

double diagonal_of(const MeshData& mesh) {
    glm::dvec3 min(std::numeric_limits<double>::infinity()), max = -min;
    for (const Tet& tet : mesh.tets) {
        for (const std::int32_t corner : tet) {
            const glm::dvec3& point = mesh.points[static_cast<std::size_t>(corner)];
            min = glm::min(min, point);
            max = glm::max(max, point);
        }
    }
    return mesh.tets.empty() ? 0 : glm::length(max - min);
}

// Drops points that no tet uses; the others stay in their order.
void drop_unused_points(MeshData& mesh) {
    std::vector<std::int32_t> number(mesh.points.size(), -1);
    for (const Tet& tet : mesh.tets) {
        for (const std::int32_t corner : tet) number[static_cast<std::size_t>(corner)] = 0;
    }
    std::int32_t count = 0;
    for (std::size_t i = 0; i < number.size(); ++i) {
        if (number[i] < 0) continue;
        const auto place = static_cast<std::size_t>(count);
        mesh.points[place] = mesh.points[i];
        for (MeshScalar& scalar : mesh.point_scalars) scalar.values[place] = scalar.values[i];
        number[i] = count++;
    }
    mesh.points.resize(static_cast<std::size_t>(count));
    for (MeshScalar& scalar : mesh.point_scalars)
        scalar.values.resize(static_cast<std::size_t>(count));
    for (Tet& tet : mesh.tets) {
        for (std::int32_t& corner : tet) corner = number[static_cast<std::size_t>(corner)];
    }
}

bool keeps_all(std::span<const HalfSpace> clip, const TetMesh::Bounds& box) {
    return std::ranges::all_of(clip, [&](const HalfSpace& half) {
        const glm::dvec3 middle = 0.5 * box.min + 0.5 * box.max, reach = box.max - middle;
        return glm::dot(half.normal, middle - half.point) >= glm::dot(glm::abs(half.normal), reach);
    });
}

// Appends the gradients' components as three scalars after the scene's, to be cut like it.
void add_gradients(const std::vector<glm::dvec3>& gradients, MeshData& mesh) {
    for (int axis = 0; axis < 3; ++axis) {
        MeshScalar& component = mesh.point_scalars.emplace_back();
        component.values.reserve(gradients.size());
        for (const glm::dvec3& gradient : gradients) component.values.push_back(gradient[axis]);
    }
}

std::vector<glm::dvec3> gradients_in(const std::vector<MeshScalar>& scalars) {
    std::vector<glm::dvec3> gradients;
    if (scalars.size() < 4) return gradients;
    gradients.reserve(scalars[1].values.size());
    for (std::size_t i = 0; i < scalars[1].values.size(); ++i)
        gradients.emplace_back(scalars[1].values[i], scalars[2].values[i], scalars[3].values[i]);
    return gradients;
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Checks a clip that a program made. (Those of scene files were checked when they were read.)
void check(const Clip& clip) {
    for (const ClipPlane& plane : clip.planes) {
        const glm::dvec3& n = plane.normal;
        if (!finite(plane.point) || !finite(n) || n == glm::dvec3(0))
            fail("clip.planes: found the normal ({}, {}, {}), expected a direction", n.x, n.y, n.z);
    }
    if (clip.box && !(finite(clip.box->min) && finite(clip.box->max)))
        fail("clip.box: found a number that is not finite");
}

}  // namespace

MeshData cut_mesh(MeshData mesh, std::span<const HalfSpace> clip,
                  std::span<const std::int32_t> places) {
    assert(mesh.cell_scalars.empty());
    MeshCutter cutter{mesh, diagonal_of(mesh), {places.begin(), places.end()}};
    for (const HalfSpace& half : clip) cutter.cut(half);
    drop_unused_points(mesh);
    return mesh;
}

std::shared_ptr<const SceneMesh> clipped_mesh(const std::shared_ptr<const SceneMesh>& mesh,
                                              const Clip& clip, bool lit, const std::string& name) {
    const std::vector<HalfSpace> halves = half_spaces(clip);
    if (keeps_all(halves, mesh->mesh.bounds())) return mesh;
    const Stage cutting("clip mesh");
    const auto points = mesh->mesh.points();
    const auto tets = mesh->mesh.tets();
    MeshData data;
    data.points.assign(points.begin(), points.end());
    data.tets.assign(tets.begin(), tets.end());
    data.point_scalars = {mesh->scalar};
    if (lit) add_gradients(gradients_of(*mesh), data);
    data = cut_mesh(std::move(data), halves, mesh->mesh.places());
    if (data.tets.empty()) return nullptr;
    std::vector<MeshScalar> scalars = std::exchange(data.point_scalars, {});
    return std::make_shared<const SceneMesh>(
        SceneMesh{TetMesh(std::move(data), name), std::move(scalars.front()), mesh->averaged,
                  mesh->report, gradients_in(scalars), mesh->quantity, mesh->length_unit});
}

std::vector<HalfSpace> half_spaces(const Clip& clip) {
    check(clip);
    std::vector<HalfSpace> found;
    for (const ClipPlane& plane : clip.planes) {
        const glm::dvec3& n = plane.normal;
        const double largest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
        glm::dvec3 scaled(0);
        for (int axis = 0; axis < 3; ++axis)
            scaled[axis] = std::scalbn(n[axis], -std::ilogb(largest));
        found.push_back({plane.point, scaled});
    }
    if (!clip.box) return found;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 normal(0);
        normal[axis] = 1;
        found.push_back({clip.box->min, normal});
        found.push_back({clip.box->max, -normal});
    }
    return found;
}

}  // namespace lamina
