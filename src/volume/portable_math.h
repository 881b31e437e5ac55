// SPDX-License-Identifier: Apache-2.0
// Functions that round in the same way on every machine with IEEE doubles, unlike those of libm. So
// generated volumes are the same everywhere. Errors are a few units in the last place.
#pragma once

namespace lamina {

double portable_exp(double x);  // x in -700..700

double portable_cos_turns(double turns);  // cos(2 pi turns)

}  // namespace lamina
