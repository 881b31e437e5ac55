// SPDX-License-Identifier: Apache-2.0
#include "selftest/layered_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/enum_words.h"
#include "compositing/codes.h"
#include "mesh/predicates.h"

namespace lamina::selftest {
namespace {

template <typename Sample>
std::shared_ptr<const void> fill(const LayeredBox& box) {
    const std::int64_t across = box.samples_across[0] * box.samples_across[1];
    auto values = std::make_shared<std::vector<Sample>>();
    values->reserve(static_cast<std::size_t>(across) * box.samples.size());
    for (const double sample : box.samples)
        values->insert(values->end(), static_cast<std::size_t>(across),
                       static_cast<Sample>(sample));
    return {values, values->data()};
}

std::int32_t add_point(MeshData& mesh, const LayeredBox& box, const glm::dvec3& place) {
    if (mesh.point_scalars.empty()) mesh.point_scalars.push_back({"scalar", {}});
    mesh.points.push_back(box.world(place));
    mesh.point_scalars[0].values.push_back(box.scalar(box.layer_at(place.z), place.z));
    return static_cast<std::int32_t>(mesh.points.size()) - 1;
}

class Random {
  public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    double uniform() { return static_cast<double>(bits_.next() >> 11) * 0x1p-53; }  // in [0, 1)
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(uniform() * static_cast<double>(count));
    }

  private:
    SplitMix64 bits_;
};

std::vector<std::size_t> permutation(std::size_t count, Random& random) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

}  // namespace

Volume LayeredBox::volume() const {
    Grid grid;
    grid.size = {samples_across[0], samples_across[1], static_cast<std::int64_t>(samples.size())};
    grid.origin = corner;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<double>(grid.size[axis]);
        grid.centering[axis] = Centering::node;
        grid.step[axis] = n > 1 ? edges[axis] / (n - 1) : edges[axis];
        // A single sample lies in the middle of its voxel.
        if (grid.size[axis] == 1) grid.origin += 0.5 * edges[axis];
    }
    switch (type) {
        case SampleType::uint8:
            return {grid, type, fill<std::uint8_t>(*this)};
        case SampleType::int16:
            return {grid, type, fill<std::int16_t>(*this)};
        case SampleType::uint16:
            return {grid, type, fill<std::uint16_t>(*this)};
        case SampleType::float32:
            return {grid, type, fill<float>(*this)};
    }
    unreachable_enum();
}

glm::dvec3 LayeredBox::world(const glm::dvec3& place) const {
    return corner + place.x * edges[0] + place.y * edges[1] + place.z * edges[2];
}

glm::dvec3 LayeredBox::place(const glm::dvec3& world) const {
    const glm::dvec3 from_corner = world - corner;
    glm::dvec3 place{0};
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3& edge = edges[static_cast<std::size_t>(axis)];
        place[axis] = glm::dot(from_corner, edge) / glm::dot(edge, edge);
    }
    return place;
}

double LayeredBox::longest_edge() const {
    return std::max({glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2])});
}

std::size_t LayeredBox::layer_at(double w) const {
    const auto count = static_cast<double>(layers());
    return static_cast<std::size_t>(std::clamp(std::floor(w * count), 0.0, count - 1));
}

double LayeredBox::layer_begin(std::size_t layer) const {
    return static_cast<double>(layer) / static_cast<double>(layers());
}

double LayeredBox::scalar(std::size_t layer, double w) const {
    if (samples.size() == 1) return samples[0];
    const double along =
        std::clamp(w * static_cast<double>(layers()) - static_cast<double>(layer), 0.0, 1.0);
    const double a = samples[layer], b = samples[layer + 1];
    return a == b ? a : a * (1 - along) + b * along;
}

bool LayeredBox::is_void(std::size_t layer) const {
    return !std::isfinite(samples[layer]) ||
           (samples.size() > 1 && !std::isfinite(samples[layer + 1]));
}

Interval LayeredBox::range() const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Interval range{infinity, -infinity};
    for (const double sample : samples) {
        if (std::isfinite(sample)) range.include(sample);
    }
    return range;
}

std::optional<BoxChord> box_chord(const LayeredBox& box, const View::Ray& ray, double slack) {
    BoxChord chord;
    chord.start = box.place(ray.origin);
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3& edge = box.edges[static_cast<std::size_t>(axis)];
        chord.step[axis] = glm::dot(ray.direction, edge) / glm::dot(edge, edge);
    }
    chord.world_per_parameter = glm::length(ray.direction);
    double begin = 0, end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double lo = -slack - chord.start[axis], hi = 1 + slack - chord.start[axis];
        if (chord.step[axis] == 0) {
            if (lo > 0 || hi < 0) return {};
            continue;
        }
        const double a = lo / chord.step[axis], b = hi / chord.step[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    for (const ClipPlane& cut : box.cuts) {
        const glm::dvec3 normal = glm::normalize(cut.normal);
        const double inside = glm::dot(normal, ray.origin - cut.point) + slack * box.longest_edge();
        const double slope = glm::dot(normal, ray.direction);
        if (slope == 0) {
            if (inside < 0) return {};
        } else if (slope > 0) {
            begin = std::max(begin, -inside / slope);
        } else {
            end = std::min(end, -inside / slope);
        }
    }
    if (!(begin < end)) return {};
    chord.parameters = {begin, end};
    return chord;
}

MeshData kuhn_tets(const LayeredBox& box, int across) {
    MeshData mesh;
    const auto layers = static_cast<int>(box.layers());
    for (int k = 0; k <= layers; ++k)
        for (int j = 0; j <= across; ++j)
            for (int i = 0; i <= across; ++i) {
                const std::int32_t point =
                    add_point(mesh, box, {1.0 * i / across, 1.0 * j / across, 1.0 * k / layers});
                // The scalar of a plane of points is that of its sample.
                if (box.samples.size() > 1)
                    mesh.point_scalars[0].values[static_cast<std::size_t>(point)] =
                        box.samples[static_cast<std::size_t>(k)];
            }
    const std::array<std::int32_t, 3> stride{1, across + 1, (across + 1) * (across + 1)};
    constexpr std::size_t axes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                        {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int k = 0; k < layers; ++k)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i)
                for (const auto& way : axes) {
                    Tet tet{i * stride[0] + j * stride[1] + k * stride[2], 0, 0, 0};
                    for (std::size_t step = 0; step < 3; ++step)
                        tet[step + 1] = tet[step] + stride[way[step]];
                    mesh.tets.push_back(tet);
                }
    return mesh;
}

MeshData fan_tets(const LayeredBox& box, int across) {
    MeshData mesh;
    const std::int32_t middle = add_point(mesh, box, {.5, .5, .5});
    std::map<std::array<int, 3>, std::int32_t> on_surface;
    const auto point_at = [&](const std::array<int, 3>& node) {
        const auto [found, is_new] = on_surface.try_emplace(node, 0);
        if (is_new)
            found->second =
                add_point(mesh, box, glm::dvec3(node[0], node[1], node[2]) / double(across));
        return found->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {0, across})
            for (int j = 0; j < across; ++j)
                for (int i = 0; i < across; ++i) {
                    const auto corner = [&](int di, int dj) {
                        std::array<int, 3> node{};
                        node[axis] = side;
                        node[(axis + 1) % 3] = i + di;
                        node[(axis + 2) % 3] = j + dj;
                        return point_at(node);
                    };
                    const std::int32_t a = corner(0, 0), d = corner(1, 1);
                    mesh.tets.push_back({middle, a, corner(1, 0), d});
                    mesh.tets.push_back({middle, a, d, corner(0, 1)});
                }
    return mesh;
}

MeshData split_tets(const LayeredBox& box, int splits, double least, std::uint32_t seed) {
    MeshData mesh = kuhn_tets(box, 1);
    Random random(seed);
    for (int split = 0; split < splits; ++split) {
        const std::size_t chosen = random.below(mesh.tets.size());
        const Tet tet = mesh.tets[chosen];
        glm::dvec3 at(0);
        double sum = 0;
        // The point lies near a face, an edge or a corner.
        const std::size_t small = 1 + random.below(3);
        const std::size_t turn = random.below(4);
        for (std::size_t i = 0; i < 4; ++i) {
            const double weight = (i + turn) % 4 < small ? least * random.uniform() : 1;
            sum += weight;
            at += weight * mesh.points[static_cast<std::size_t>(tet[i])];
        }
        std::array<Tet, 4> parts{tet, tet, tet, tet};
        const std::int32_t point = add_point(mesh, box, box.place(at / sum));
        bool inside = true;  // inside the tet even after rounding
        const auto place = [&](std::int32_t corner) {
            return mesh.points[static_cast<std::size_t>(corner)];
        };
        const auto side = [&](const Tet& each) {
            return orientation(place(each[0]), place(each[1]), place(each[2]), place(each[3]));
        };
        for (std::size_t i = 0; i < 4; ++i) {
            parts[i][i] = point;
            inside = inside && side(parts[i]) == side(tet);
        }
        if (!inside) {
            mesh.points.pop_back();
            mesh.point_scalars[0].values.pop_back();
            continue;
        }
        mesh.tets[chosen] = parts[0];
        mesh.tets.insert(mesh.tets.end(), parts.begin() + 1, parts.end());
    }
    return mesh;
}

MeshData shuffled(const MeshData& mesh, std::uint32_t seed) {
    Random random(seed);
    const std::vector<std::size_t> points = permutation(mesh.points.size(), random);
    MeshData other;
    other.points.resize(points.size());
    other.point_scalars = mesh.point_scalars;
    for (std::size_t i = 0; i < points.size(); ++i) {
        other.points[points[i]] = mesh.points[i];
        other.point_scalars[0].values[points[i]] = mesh.point_scalars[0].values[i];
    }
    for (const std::size_t chosen : permutation(mesh.tets.size(), random)) {
        Tet tet{};
        const std::vector<std::size_t> corners = permutation(4, random);
        for (std::size_t i = 0; i < 4; ++i)
            tet[corners[i]] =
                static_cast<std::int32_t>(points[static_cast<std::size_t>(mesh.tets[chosen][i])]);
        other.tets.push_back(tet);
    }
    return other;
}

}  // namespace lamina::selftest
