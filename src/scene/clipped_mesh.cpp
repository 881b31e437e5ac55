// SPDX-License-Identifier: Apache-2.0
#include "scene/clipped_mesh.h"

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
#include <vector>

#include "base/parallel.h"
#include "base/profile.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

// Distances up to which a corner lies on a plane, as a share of the mesh's diagonal and in
// roundings of coordinates. Renderers place faces to 9e-6 of an edge (docs/numerics.md, section 6).
constexpr double near_of_diagonal = 1e-10, near_of_coordinates = 0x1p-46;

// Corners 0, 1, 2 and 3, 4, 5 are triangles with the edges 0-3, 1-4, 2-5 between them; corner 3
// lies where 0, 1, 2 are seen counter-clockwise.
using Prism = std::array<std::int32_t, 6>;

// Cuts a mesh by one plane after the other.
class MeshCutter {
  public:
    MeshCutter(MeshData& mesh, double diagonal) : mesh_(mesh), diagonal_(diagonal) {}

    void cut(const HalfSpace& half) {
        measure_distances(half);
        if (std::ranges::none_of(distances_, [](double d) { return d < 0; })) return;
        cut_points_.clear();
        std::vector<Tet> tets = std::exchange(mesh_.tets, {});
        mesh_.tets.reserve(tets.size());
        for (const Tet& tet : tets) add_kept(tet);
    }

  private:
    void measure_distances(const HalfSpace& half) {
        const glm::dvec3 normal = glm::normalize(half.normal);
        distances_.resize(mesh_.points.size());
        parallel_for(static_cast<std::int64_t>(distances_.size()), 4096, [&](std::int64_t i) {
            const glm::dvec3& point = mesh_.points[static_cast<std::size_t>(i)];
            const double distance = glm::dot(normal, point - half.point);
            const double near = near_of_diagonal * diagonal_ +
                                near_of_coordinates * (norm1(point) + norm1(half.point));
            distances_[static_cast<std::size_t>(i)] = std::abs(distance) <= near ? 0 : distance;
        });
    }

    double distance(std::int32_t point) const {
        return distances_[static_cast<std::size_t>(point)];
    }

    void add_kept(const Tet& tet) {
        int inside = 0, outside = 0;
        for (const std::int32_t corner : tet) {
            inside += distance(corner) > 0;
            outside += distance(corner) < 0;
        }
        if (inside == 0) return;
        if (outside == 0) {
            mesh_.tets.push_back(tet);
            return;
        }
        const Tet corners = inside_first(tet);
        const auto [a, b, c, d] = corners;
        switch (inside) {
            case 1:
                mesh_.tets.push_back({a, cut_point(a, b), cut_point(a, c), cut_point(a, d)});
                break;
            case 2:
                add_prism(
                    {a, cut_point(a, c), cut_point(a, d), b, cut_point(b, c), cut_point(b, d)});
                break;
            default:
                add_prism({a, b, c, cut_point(a, d), cut_point(b, d), cut_point(c, d)});
        }
    }

    // Returns an even permutation of the corners with those inside first.
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
        // Two corners on the same side may change places.
        if (odd && outside(tet[0]) == outside(tet[1]))
            std::swap(tet[0], tet[1]);
        else if (odd)
            std::swap(tet[2], tet[3]);
        return tet;
    }

    // Returns the point at which an edge leaves the half-space, with its scalars: one point for all
    // tets at the edge.
    std::int32_t cut_point(std::int32_t inside, std::int32_t outside) {
        if (distance(outside) == 0) return outside;
        const auto [a, b] = std::minmax(inside, outside);
        const auto key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint64_t>(b);
        const auto [found, is_new] =
            cut_points_.try_emplace(key, static_cast<std::int32_t>(mesh_.points.size()));
        if (!is_new) return found->second;
        const double share = distance(a) / (distance(a) - distance(b));
        append_between(mesh_.points, a, b, share);
        for (MeshScalar& scalar : mesh_.point_scalars) append_between(scalar.values, a, b, share);
        return found->second;
    }

    // Interpolates linearly; two equal values give exactly the same value.
    template <typename Value>
    static void append_between(std::vector<Value>& values, std::int32_t a, std::int32_t b,
                               double share) {
        const Value first = values[static_cast<std::size_t>(a)];
        values.push_back(first + share * (values[static_cast<std::size_t>(b)] - first));
    }

    // Adds a prism as tets. Each side with four corners is cut from its corner of the least number,
    // so that neighbours agree (Dompierre et al. 1999). If a corner of the tet lies on the plane,
    // corners coincide, and tets that have a corner twice are left out.
    void add_prism(const Prism& prism) {
        const auto least =
            static_cast<std::size_t>(std::ranges::min_element(prism) - prism.begin());
        static constexpr std::array<std::array<std::size_t, 6>, 6> from{{{0, 1, 2, 3, 4, 5},
                                                                         {1, 2, 0, 4, 5, 3},
                                                                         {2, 0, 1, 5, 3, 4},
                                                                         {3, 5, 4, 0, 2, 1},
                                                                         {4, 3, 5, 1, 0, 2},
                                                                         {5, 4, 3, 2, 1, 0}}};
        const auto corner = [&](std::size_t i) { return prism[from[least][i]]; };
        if (std::min(corner(1), corner(5)) < std::min(corner(2), corner(4))) {
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
        if (std::ranges::adjacent_find(sorted) == sorted.end()) mesh_.tets.push_back(tet);
    }

    MeshData& mesh_;
    double diagonal_;
    std::vector<double> distances_;  // distance of each point from the plane; 0: on it
    std::unordered_map<std::uint64_t, std::int32_t> cut_points_;  // by the numbers of both ends
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

// Adds the gradients as three scalars behind the scene's.
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

}  // namespace

MeshData cut_mesh(MeshData mesh, std::span<const HalfSpace> clip) {
    assert(mesh.cell_scalars.empty());
    MeshCutter cutter(mesh, diagonal_of(mesh));
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
    data = cut_mesh(std::move(data), halves);
    if (data.tets.empty()) return nullptr;
    std::vector<MeshScalar> scalars = std::exchange(data.point_scalars, {});
    return std::make_shared<const SceneMesh>(SceneMesh{TetMesh(std::move(data), name),
                                                       std::move(scalars.front()), mesh->averaged,
                                                       mesh->report, gradients_in(scalars)});
}

}  // namespace lamina
