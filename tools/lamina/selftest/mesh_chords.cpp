// SPDX-License-Identifier: Apache-2.0
#include "selftest/mesh_chords.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "optics/segment_integral.h"
#include "selftest/optics_range.h"

namespace lamina::selftest {

MeshChords::MeshChords(const SceneMesh& mesh, const View& view, double face_error)
    : eye_(view.eye) {
    for (const Tet& tet : mesh.mesh.tets()) {
        std::array<glm::dvec3, 4> at;
        std::array<double, 4> value{};
        for (std::size_t i = 0; i < 4; ++i) {
            at[i] = mesh.mesh.points()[static_cast<std::size_t>(tet[i])] - eye_;
            value[i] = mesh.scalar.values[static_cast<std::size_t>(tet[i])];
        }
        const double volume = glm::dot(glm::cross(at[1] - at[0], at[2] - at[0]), at[3] - at[0]);
        if (volume == 0 || !std::all_of(value.begin(), value.end(),
                                        [](double each) { return std::isfinite(each); }))
            continue;
        Solid& solid = solids_.emplace_back();
        solid.scalars = {value[0], value[0]};
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 &a = at[(i + 1) % 4], &b = at[(i + 2) % 4], &c = at[(i + 3) % 4];
            glm::dvec3 normal = glm::cross(b - a, c - a);
            const double area = glm::length(normal);
            const double height = glm::dot(normal, at[i] - a);
            solid.gradient += value[i] / height * normal;
            normal = (height > 0 ? -1 : 1) / area * normal;
            solid.normals[i] = normal;
            solid.offsets[i] = glm::dot(normal, a);
            solid.scalars.include(value[i]);
            for (std::size_t j = 0; j < i; ++j)
                solid.error = std::max(solid.error, face_error * glm::length(at[i] - at[j]));
        }
        solid.scalar_at_eye = value[0] - glm::dot(solid.gradient, at[0]);
    }
}

Interval MeshChords::parameters_inside(const Solid& solid, const View::Ray& ray,
                                       const glm::dvec3& from_eye, double outwards) {
    Interval inside{0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 4; ++i) {
        const double speed = glm::dot(solid.normals[i], ray.direction);
        const double distance = solid.offsets[i] + outwards - glm::dot(solid.normals[i], from_eye);
        if (speed > 0) inside.hi = std::min(inside.hi, distance / speed);
        if (speed < 0) inside.lo = std::max(inside.lo, distance / speed);
        if (speed == 0 && distance < 0) return {};
    }
    return inside.lo < inside.hi ? inside : Interval{};
}

MeshChords::Along MeshChords::along(const View::Ray& ray,
                                    const TransferFunction& transfer_function) const {
    Along sum;
    const glm::dvec3 from_eye = ray.origin - eye_;
    const double per_parameter = glm::length(ray.direction);
    for (const Solid& solid : solids_) {
        const Interval widest = parameters_inside(solid, ray, from_eye, solid.error);
        if (!(widest.width() > 0)) continue;
        const Interval inside = parameters_inside(solid, ray, from_eye, 0);
        const Interval narrowest = parameters_inside(solid, ray, from_eye, -solid.error);
        const auto scalar_at = [&](double parameter) {
            const glm::dvec3 at = from_eye + parameter * ray.direction;
            return std::clamp(solid.scalar_at_eye + glm::dot(solid.gradient, at), solid.scalars.lo,
                              solid.scalars.hi);
        };
        const double length = inside.width() * per_parameter;
        const double depth =
            integrate_segment(transfer_function, scalar_at(inside.lo), scalar_at(inside.hi), length)
                .optical_depth;
        const double most = optics_range(transfer_function, solid.scalars).extinction.hi;
        ++sum.crossed;
        sum.depth += depth;
        sum.length_error += (widest.width() - narrowest.width()) * per_parameter;
        sum.possible_depth.lo +=
            std::max(0.0, depth - most * (inside.width() - narrowest.width()) * per_parameter);
        sum.possible_depth.hi += depth + most * (widest.width() - inside.width()) * per_parameter;
    }
    return sum;
}

}  // namespace lamina::selftest
