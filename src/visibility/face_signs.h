// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "lamina/tet.h"
#include "mesh/predicates.h"
#include "mesh/tet_mesh.h"

namespace lamina {

// So many tets are looked at in one task.
inline constexpr std::int64_t tets_per_task = 4096;

// On which side of a tet's faces the eye is. Bit f: the eye is on the outer side of face f, so the
// tet across that face is nearer to the eye. Bit 4 + f: the eye is on the inner side, so the tet
// across is farther. A face that is seen edge-on has neither bit and hides nothing.
using FaceSigns = std::uint32_t;
constexpr FaceSigns nearer_bit(std::size_t face) {
    return FaceSigns{1} << face;
}
constexpr FaceSigns farther_bit(std::size_t face) {
    return FaceSigns{16} << face;
}

// Whether sorting the corners of a face by their numbers reverses its orientation. This is true for
// one of the two tets that share the face.
inline bool turned_by_sorting(const Tet& tet, std::size_t face) {
    const auto [a, b, c] = corners_of_face(tet, face);
    return (a > b) != ((b > c) != (a > c));
}

// Whether the eye is in front of a face. Where the face is seen edge-on, the eye counts as in front
// for one of its two tets.
inline bool is_front(const Tet& tet, std::size_t face, FaceSigns signs) {
    const bool nearer = (signs & nearer_bit(face)) != 0, farther = (signs & farther_bit(face)) != 0;
    return nearer || (!farther && turned_by_sorting(tet, face));
}

// The exact sign of the solid angle (for an eye at infinity, of the projected area) of the triangle
// a, b, c. It is positive where the eye sees the corners clockwise. So for a face whose corners are
// counter-clockwise from outside its tet, it is positive where the eye is on the inner side.
inline int sign_as_seen(const Eye& eye, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c) {
    const glm::dvec3& e = eye.position;
    if (eye.at_infinity) return sign_of_determinant(e, glm::dvec3(0), b, a, c, a);
    return sign_of_determinant(a, e, b, e, c, e);
}

// Finds the signs of a mesh's tets for one eye. Signs are computed in floating point where an error
// bound decides them, and exactly elsewhere, so that the two tets of a face always agree. Safe from
// many threads.
class FaceSigner {
  public:
    FaceSigner(const TetMesh& mesh, const Eye& eye)
        : points_(mesh.points()), tets_(mesh.tets()), eye_(eye) {}

    FaceSigns signs(std::size_t tet) const;

  private:
    struct Rounded {
        std::array<double, 4> determinants;
        double error;
    };
    Rounded rounded(const Tet& tet) const;
    Rounded rounded_at_infinity(const Tet& tet) const;
    int exact(const Tet& tet, std::size_t face) const;

    std::span<const glm::dvec3> points_;
    std::span<const Tet> tets_;
    Eye eye_;
};

}  // namespace lamina
