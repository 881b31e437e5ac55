// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace lamina {

// What a part's fragments need. Programs of later kinds are right for parts of the earlier ones,
// too, and slower.
enum class FragmentKind {
    thin,    // a part of optical depth up to thin_depth (optics/front_weights.h)
    plain,   // faces in float32
    careful  // faces in double: seen nearly edge-on, cut by the near plane, or around the eye
};
inline constexpr std::size_t fragment_kinds = 3;

}  // namespace lamina
