// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "lamina/tet.h"
#include "scene/window_view.h"
#include "visibility/face_signs.h"

namespace lamina {

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

}  // namespace lamina
