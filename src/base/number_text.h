// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina {

// A number for people: with `digits` significant digits, or with so many more that it is within
// `fineness` of the value. So numbers that lie close together far from zero can be told apart.
std::string number_text(double value, double fineness, int digits = 4);

// The fineness that tells values of a range from lo to hi apart: a thousandth of it, and more than
// 0.
double fineness_of(double lo, double hi);

// A share as a percentage with three digits.
std::string percent_text(double share);

}  // namespace lamina
