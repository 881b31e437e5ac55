// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::selftest {

// The precision of the quantities that a way to draw integrates. The bounds of the self-test follow
// from it.
struct Precision {
    double position = 0;  // error of a point in the box, share of its edges
    double relative = 0;  // relative error of lengths and optical depths
    double scalar = 0;    // error of scalars, share of the volume's range
    double color = 0;     // error of a piece's colour, share of the colours that occur in it
    double face = 0;      // error of a tet's face, share of the tet's longest edge
    double slab = 0;      // error of a slab's ends, share of the depth of all slabs

    // Some 16 roundings of a float32 (2^-24). Coordinates in the box have the size of the box at
    // any distance of the eye, because rays are set up in double precision. Faces:
    // docs/numerics.md, section 6 (9e-6 of an edge with coefficients relative to a pixel near the
    // tet). Colour of a cell fragment: 2.2e-3, from a table of 256 x 256
    // (optics/segment_integral.h).
    static constexpr Precision drawn() {
        constexpr double ulps = 1.0 / (1 << 20);
        return {ulps, ulps, ulps, 2.2e-3, 9e-6, ulps};
    }
    // Double precision, as in the tracers, with eyes up to 1e6 box lengths away.
    static constexpr Precision traced() { return {1e-9, 1e-12, 1e-12, 1e-12, 1e-9, 0}; }
};

}  // namespace lamina::selftest
