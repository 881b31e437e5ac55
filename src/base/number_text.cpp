// SPDX-License-Identifier: Apache-2.0
#include "base/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace lamina {

std::string number_text(double value, double fineness, int digits) {
    // Beside others like it, 1000000 is easier to read than 1e+06.
    if (fineness < 1e-4 * std::abs(value) && std::abs(value) < 1e15)
        digits = std::max(digits, static_cast<int>(std::log10(std::abs(value))) + 1);
    std::string text = fmt::format("{:.{}g}", value, digits);
    for (int more = digits + 1; more <= std::numeric_limits<double>::max_digits10; ++more) {
        double shown = 0;
        std::from_chars(text.data(), text.data() + text.size(), shown);
        // Not a number, or infinite: no digits help.
        if (!std::isfinite(value) || std::abs(shown - value) <= fineness) break;
        text = fmt::format("{:.{}g}", value, more);
    }
    return text;
}

double fineness_of(double lo, double hi) {
    const double fineness = hi / 1000 - lo / 1000;
    return fineness > 0 ? fineness : std::numeric_limits<double>::infinity();
}

std::string percent_text(double share) {
    return fmt::format("{:.3g} %", 100 * share);
}

}  // namespace lamina
