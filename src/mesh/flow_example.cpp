// SPDX-License-Identifier: Apache-2.0
#include "mesh/flow_example.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

#include "base/parallel.h"
#include "volume/generate.h"
#include "volume/gradient_noise.h"

// Lengths are in diameters of the cylinder, speeds in that of the flow far in front of it, which
// runs along x. The cylinder stands on z = 0 with its axis at x = y = 0.
namespace lamina {
namespace {

using glm::dvec2, glm::dvec3;

constexpr std::int64_t rings = 40, spokes = 80,
                       layers = 12;  // cells from the cylinder outwards, around it, upwards
constexpr double cylinder_radius = 0.5;
constexpr double box_height = 3.4;
const dvec2 outer_middle{3.2, 0}, outer_half{5.8, 2.6};  // of the outer boundary, a rounded box
constexpr double crowding =
    1.9;  // logarithm of the ratio of the outermost to the innermost cell's length
constexpr double crowding_behind =
    0.4;  // 0: spokes evenly around; more: crowded behind the cylinder

// Returns where the ray from the origin leaves the curve |x|^4 + |y|^4 = 1 around the outer middle.
double distance_to_outer(const dvec2& direction) {
    double inside = cylinder_radius, outside = 20;
    for (int step = 0; step < 60; ++step) {
        const double middle = (inside + outside) / 2;
        const dvec2 p = (middle * direction - outer_middle) / outer_half;
        const dvec2 square = p * p;
        (glm::dot(square, square) < 1 ? inside : outside) = middle;
    }
    return inside;
}

std::size_t point_index(std::int64_t ring, std::int64_t spoke, std::int64_t layer) {
    return static_cast<std::size_t>((layer * spokes + spoke % spokes) * (rings + 1) + ring);
}

std::vector<dvec3> flow_points() {
    std::vector<dvec3> points(point_index(rings, spokes - 1, layers) + 1);
    for (std::int64_t spoke = 0; spoke < spokes; ++spoke) {
        const double even = static_cast<double>(spoke) / static_cast<double>(spokes);  // turns
        const double turns =
            even - crowding_behind / (2 * std::numbers::pi) * portable_cos_turns(even - 0.25);
        const dvec2 direction{portable_cos_turns(turns), portable_cos_turns(turns - 0.25)};
        const double reach = distance_to_outer(direction) - cylinder_radius;
        for (std::int64_t ring = 0; ring <= rings; ++ring) {
            const double s = static_cast<double>(ring) / static_cast<double>(rings);
            const double share = (portable_exp(crowding * s) - 1) / (portable_exp(crowding) - 1);
            const dvec2 p = (cylinder_radius + reach * share) * direction;
            for (std::int64_t layer = 0; layer <= layers; ++layer)
                points[point_index(ring, spoke, layer)] = {
                    p, box_height * static_cast<double>(layer) / static_cast<double>(layers)};
        }
    }
    return points;
}

// Cuts each cell into six tets along its diagonal (Kuhn), so that neighbours fit.
std::vector<Tet> flow_tets() {
    // Order of the three directions in which a path along edges crosses the cell; the last three
    // paths are odd permutations, whose tets would be turned over.
    constexpr int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    std::vector<Tet> tets;
    for (std::int64_t layer = 0; layer < layers; ++layer) {
        for (std::int64_t spoke = 0; spoke < spokes; ++spoke) {
            for (std::int64_t ring = 0; ring < rings; ++ring) {
                for (int path = 0; path < 6; ++path) {
                    std::array<std::int64_t, 3> at{ring, spoke, layer};
                    Tet tet;
                    for (std::size_t corner = 0; corner < 4; ++corner) {
                        if (corner > 0) ++at[static_cast<std::size_t>(paths[path][corner - 1])];
                        tet[corner] = static_cast<std::int32_t>(point_index(at[0], at[1], at[2]));
                    }
                    if (path >= 3) std::swap(tet[2], tet[3]);
                    tets.push_back(tet);
                }
            }
        }
    }
    return tets;
}

struct FlowValues {
    double pressure, speed, vorticity;
};

// The vortices behind the cylinder at one height: they leave it in turns from both sides,
// travel away, grow and lose strength.
struct Vortex {
    dvec2 center;
    double radius, circulation;
};

std::vector<Vortex> vortices_at(double z) {
    const GradientNoise wander(0xf10a);
    // They bend as they rise, and are weaker near the ground.
    const double shift = 0.8 * wander.at(0.37, 0.21, 0.8 * z + 3.4) + 0.14 * z;
    const double ground = smooth_step(0.15 + z / 0.9);
    std::vector<Vortex> vortices;
    for (int i = 0; i < 7; ++i) {
        const double x = 0.95 + 1.35 * i + shift * smooth_step((0.6 + i) / 2);
        const double side = i % 2 == 0 ? 1 : -1;
        const double sway = 0.3 * wander.at(5.3 * i + 0.4, 0.6, 1.1 * z + 0.7);
        const double age = std::max(0.0, x - 0.9);
        vortices.push_back({{x, side * (0.42 + 0.035 * age) + sway},
                            0.25 + 0.045 * age,
                            -side * 2.6 * ground * portable_exp(-0.13 * age)});
    }
    return vortices;
}

FlowValues flow_at(const dvec3& p, const std::vector<Vortex>& vortices) {
    const dvec2 q{p.x, p.y};
    const double r2 = glm::dot(q, q);
    const double r = std::sqrt(r2);
    const double ratio = cylinder_radius * cylinder_radius / r2;
    const double wall = smooth_step((r - cylinder_radius) / 0.28);  // 0 at the cylinder
    const double behind = smooth_step((p.x + 0.1) / 0.7);
    // Potential flow around a cylinder; its wake is slower, and wider farther away.
    dvec2 velocity{1 - ratio * (p.x * p.x - p.y * p.y) / r2, -ratio * 2 * p.x * p.y / r2};
    const double potential_pressure = 1 - glm::dot(velocity, velocity);
    const double width = 0.5 + 0.07 * std::max(0.0, p.x);
    const double wake =
        behind * portable_exp(-p.y * p.y / (width * width) - 0.12 * std::max(0.0, p.x));
    velocity.x -= 0.75 * wake;
    double pressure = potential_pressure * (1 - 0.9 * behind) - 0.35 * wake;
    double vorticity = (1 - wall) * 3 * (r > 0 ? -p.y / r : 0);
    for (const Vortex& vortex : vortices) {
        const dvec2 from = q - vortex.center;
        const double distance2 = glm::dot(from, from);
        const double core =
            portable_exp(-std::min(distance2 / (vortex.radius * vortex.radius), 60.0));
        const double turn =
            vortex.circulation / (2 * std::numbers::pi * std::max(distance2, 1e-9)) * (1 - core);
        velocity += 0.8 * turn * dvec2{-from.y, from.x};
        vorticity += vortex.circulation / (std::numbers::pi * vortex.radius * vortex.radius) * core;
        const double swirl = vortex.circulation / (2 * std::numbers::pi * vortex.radius);
        pressure -= 0.9 * swirl * swirl * core;
    }
    const double floor = smooth_step(0.25 + p.z / 0.35);  // the flow is slower above the ground
    return {pressure * (0.55 + 0.45 * floor), glm::length(velocity) * wall * floor, vorticity};
}

}  // namespace

MeshData flow_mesh() {
    MeshData mesh;
    mesh.points = flow_points();
    mesh.tets = flow_tets();
    for (const char* const name : {"vorticity", "pressure", "speed"})
        mesh.point_scalars.push_back({name, std::vector<double>(mesh.points.size())});
    const std::size_t layer_points = mesh.points.size() / (layers + 1);
    parallel_for(layers + 1, 1, [&](std::int64_t layer) {
        const std::size_t first = static_cast<std::size_t>(layer) * layer_points;
        const std::vector<Vortex> vortices = vortices_at(mesh.points[first].z);
        for (std::size_t i = first; i < first + layer_points; ++i) {
            const FlowValues values = flow_at(mesh.points[i], vortices);
            mesh.point_scalars[0].values[i] = values.vorticity;
            mesh.point_scalars[1].values[i] = values.pressure;
            mesh.point_scalars[2].values[i] = values.speed;
        }
    });
    return mesh;
}

}  // namespace lamina
