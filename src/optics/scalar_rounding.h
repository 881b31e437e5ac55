// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// Rounding of scalars, as a share of the window to which they are normalised: they and the transfer
// function's points are float32 numbers of the window, rounded a few times by at most half of 2^-23
// of it. For pieces of tets scalars are normalised to the piece, and this does not apply.
inline constexpr double scalar_rounding = 0x1p-22;

// Width, in roundings, up to which a ramp of the transfer function counts as a jump: on wider ones
// a rounding moves a scalar by less than a thousandth of the ramp.
inline constexpr double steep_width = 1024;

}  // namespace lamina
