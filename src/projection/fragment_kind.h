// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace lamina {

// How the fragments of a cell fragment (TetPart) are computed. A later kind is also right for what
// an earlier one serves, but slower.
enum class FragmentKind {
    thin,   // optical depth at most thin_depth (optics/front_weights.h); depths on faces in float32
    plain,  // depths on faces in float32
    careful  // depths on faces in double precision: for faces that are seen nearly edge-on, for
             // cell fragments that the near plane cuts, and where the eye is inside
};
inline constexpr std::size_t fragment_kinds = 3;

}  // namespace lamina
