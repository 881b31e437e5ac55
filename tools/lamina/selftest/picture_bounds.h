// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "lamina/image.h"
#include "lamina/transfer_function.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "selftest/drawing_way.h"
#include "selftest/layered_box.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

// Chords of rays in the tets of a mesh. Each tet is intersected separately in double precision,
// without its neighbours, which is right for every mesh, even one that overlaps itself.
class MeshChords {
  public:
    // `face_error`: error of the position of faces, as a share of a tet's longest edge.
    MeshChords(const SceneMesh& mesh, const View& view, double face_error);

    struct Along {
        double depth = 0;         // optical depth
        Interval possible_depth;  // range that the errors of faces allow
        double length_error = 0;  // sum over the chords of all tets, world units
        int crossed = 0;          // number of tets that the ray may meet
    };
    Along along(const View::Ray& ray, const TransferFunction& transfer_function) const;

  private:
    struct Solid {
        std::array<glm::dvec3, 4> normals;  // unit, outwards
        std::array<double, 4> offsets;      // distances of the faces from the eye
        double error = 0;                   // position error of its faces, in world units
        glm::dvec3 gradient{0};             // gradient of the scalar
        double scalar_at_eye = 0;
        Interval scalars;
    };
    static Interval parameters_inside(const Solid& solid, const View::Ray& ray,
                                      const glm::dvec3& from_eye, double outwards);

    glm::dvec3 eye_;
    std::vector<Solid> solids_;
};

// The exact value of every pixel, and the bounds that a way to draw must keep.
struct PictureBounds {
    int width = 0, height = 0;
    std::vector<std::array<double, 4>> exact;
    std::vector<PixelBounds> possible;
};

// Returns the bounds for a layered box. `mesh`: for ways that draw a mesh, else null.
PictureBounds layered_picture(const SelftestScene& scene, const DrawingWay& way,
                              const SceneMesh* mesh);

// Returns the bounds for any mesh in one colour. Opacity follows from the sum of its tets' optical
// depths, in any order.
PictureBounds one_color_picture(const Scene& scene, const DrawingWay& way, const SceneMesh& mesh);

// How well a picture keeps its bounds.
struct Fit {
    bool fits = true;
    double error = 0, bound = 0;  // in 1/255, in the pixel and channel that fits worst
    double largest_error = 0;     // in 1/255
    std::string where;  // first pixel and channel outside its bounds: "pixel 3, 4, channel R"
};
Fit fit_of(const PreciseImage& picture, const PictureBounds& bounds);

// Returns the fit of two pictures that should agree: they may differ by what both bounds allow.
Fit fit_of(const PreciseImage& a, const PictureBounds& bounds_a, const PreciseImage& b,
           const PictureBounds& bounds_b);

}  // namespace lamina::selftest
