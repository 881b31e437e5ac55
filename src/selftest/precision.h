// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::selftest {

// How exactly a way to draw knows what it integrates; the bounds of the self-test follow from it.
struct Precision {
    double position = 0;  // of a point in the box, share of its edges
    double relative = 0;  // of lengths and optical depths
    double scalar = 0;    // share of the volume's range
    double color = 0;     // of a piece's colour, share of the colours met in it
    double face = 0;      // of a tet's face, share of the tet's longest edge
    double slab = 0;      // of a slab's ends, share of the depth of all slabs

    // Some 16 roundings of a float32 (2^-24): coordinates in the box have its size, whatever the
    // eye's distance, since rays are set up in double. Faces: docs/numerics.md, section 6 (9e-6 of
    // an edge with coefficients relative to a pixel near the tet). Colour of a part of a tet:
    // 2.2e-3, from a table of 256 x 256 (optics/front_weights.h).
    static constexpr Precision drawn() {
        constexpr double ulps = 1.0 / (1 << 20);
        return {ulps, ulps, ulps, 2.2e-3, 9e-6, ulps};
    }
    // Double precision: what the tracers have, with eyes up to 1e6 box lengths away.
    static constexpr Precision traced() { return {1e-9, 1e-12, 1e-12, 1e-12, 1e-9, 0}; }
};

}  // namespace lamina::selftest
