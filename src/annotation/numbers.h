// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lamina {

// Returns the largest number 1, 2 or 5 times a power of ten that is at most `most` > 0.
double round_number_up_to(double most);

// Marks at multiples of a round step.
struct Ticks {
    double step = 0;
    std::vector<double> values;  // ascending
};

// Returns the ticks from lo to hi (lo < hi) with the smallest step that makes at most `most` >= 2.
// There may be fewer than two if `most` is small.
Ticks ticks_between(double lo, double hi, int most);

// Returns numbers as texts with a common number of digits, as many as multiples of `step` need, and
// with a typographic minus sign. Very large and very small numbers have an exponent.
std::vector<std::string> number_texts(const std::vector<double>& values, double step);
std::string number_text(double value);  // with up to 6 digits

// Returns what is wrong with a format of numbers (Annotation::format), as "found ..., expected
// ...", or nothing.
std::optional<std::string> mistake_in_format(const std::string& format);
std::string formatted(const std::string& format, double value);  // the format must have no mistake

}  // namespace lamina
