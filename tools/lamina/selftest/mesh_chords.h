// SPDX-License-Identifier: Apache-2.0
// Rays through a mesh that does not use its neighbours: every tet is intersected by itself, in
// double precision. This is right for every mesh, also where it overlaps itself.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

#include "lamina/transfer_function.h"
#include "scene/camera.h"
#include "scene/scene_mesh.h"
#include "selftest/interval.h"

namespace lamina::selftest {

class MeshChords {
  public:
    // `face_error`: error of the position of faces, as a share of a tet's longest edge.
    MeshChords(const SceneMesh& mesh, const View& view, double face_error);

    struct Along {
        double depth = 0;         // optical depth
        Interval possible_depth;  // range of the optical depth that the errors of faces allow
        double length_error = 0;  // sum over the chords of all tets, world units
        int crossed = 0;          // number of tets that the ray may meet
    };
    Along along(const View::Ray& ray, const TransferFunction& transfer_function) const;

  private:
    struct Solid {
        std::array<glm::dvec3, 4> normals;  // unit, outwards
        std::array<double, 4> offsets;      // distances of the faces from the eye
        double error = 0;                   // world
        glm::dvec3 gradient{0};             // gradient of the scalar
        double scalar_at_eye = 0;
        Interval scalars;
    };
    static Interval parameters_inside(const Solid& solid, const View::Ray& ray,
                                      const glm::dvec3& from_eye, double outwards);

    glm::dvec3 eye_;
    std::vector<Solid> solids_;
};

}  // namespace lamina::selftest
