// SPDX-License-Identifier: Apache-2.0
// Rays through a mesh without its neighbourhoods: every tet by itself, in double precision. Right
// for every mesh, overlapping or not.
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
    // `face_error`: of the places of faces, share of a tet's longest edge.
    MeshChords(const SceneMesh& mesh, const View& view, double face_error);

    struct Along {
        double depth = 0;         // optical
        Interval possible_depth;  // with faces off by their error
        double length_error = 0;  // of all tets' chords together, world
        int crossed = 0;          // tets that the ray may meet
    };
    Along along(const View::Ray& ray, const TransferFunction& transfer_function) const;

  private:
    struct Solid {
        std::array<glm::dvec3, 4> normals;  // unit, outwards
        std::array<double, 4> offsets;      // of the faces from the eye
        double error = 0;                   // world
        glm::dvec3 gradient{0};             // of the scalar
        double scalar_at_eye = 0;
        Interval scalars;
    };
    static Interval parameters_inside(const Solid& solid, const View::Ray& ray,
                                      const glm::dvec3& from_eye, double outwards);

    glm::dvec3 eye_;
    std::vector<Solid> solids_;
};

}  // namespace lamina::selftest
