// SPDX-License-Identifier: Apache-2.0
#include "annotation/numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/error.h"

namespace lamina {
namespace {

// Numbers whose absolute values lie between these are written without an exponent.
constexpr double least_plain = 1e-4, largest_plain = 1e6;
constexpr int most_digits = 17;

// A round number: digit times ten to the power of `exponent`.
struct Round {
    int digit, exponent;

    // Parsing the decimal text gives the nearest double, which powers and products may miss.
    double value() const {
        return std::strtod(fmt::format("{}e{}", digit, exponent).c_str(), nullptr);
    }
};

// Smaller and larger numbers are taken for these: their powers of ten are no normal doubles.
constexpr double least_round = 1e-300, largest_round = 1e300;

Round round_up_to(double number) {
    const double most = std::clamp(number, least_round, largest_round);
    // Down from a power of ten that is too large for sure.
    int exponent = static_cast<int>(std::floor(std::log10(most))) + 1;
    for (;; --exponent) {
        for (const int digit : {5, 2, 1}) {
            if (Round{digit, exponent}.value() <= most) return {digit, exponent};
        }
    }
}

Round next(const Round& round) {
    if (round.digit == 5) return {1, round.exponent + 1};
    return {round.digit == 1 ? 2 : 5, round.exponent};
}

// Puts the minus sign of mathematics (U+2212) in place of hyphens, and a short form in place of
// "e+06".
std::string tidied(const std::string& number) {
    const std::size_t e = number.find('e');
    std::string text = number.substr(0, e);
    if (e != number.npos) text += fmt::format("e{}", std::stoi(number.substr(e + 1)));
    for (std::size_t at = text.find('-'); at != text.npos; at = text.find('-', at))
        text.replace(at, 1, "\u2212");
    return text;
}

}  // namespace

double round_number_up_to(double most) {
    return round_up_to(most).value();
}

Ticks ticks_between(double lo, double hi, int most) {
    for (Round step = round_up_to((hi - lo) / most);; step = next(step)) {
        Ticks ticks{step.value(), {}};
        // Multiples are computed from whole numbers, so that errors do not add up.
        const double first = std::ceil(lo / ticks.step - 1e-9);
        const double last = std::floor(hi / ticks.step + 1e-9);
        if (last - first + 1 > most) continue;
        for (int i = 0; first + i <= last && i < most; ++i)
            ticks.values.push_back(std::clamp((first + i) * ticks.step, lo, hi));
        return ticks;
    }
}

std::vector<std::string> number_texts(const std::vector<double>& values, double step) {
    double largest = 0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    const int exponent_of_step = round_up_to(step).exponent;
    std::vector<std::string> texts;
    if (largest < largest_plain && step >= least_plain) {
        const int decimals = std::max(0, -exponent_of_step);
        for (const double value : values)
            texts.push_back(tidied(fmt::format("{:.{}f}", value + 0.0, decimals)));
        return texts;
    }
    for (const double value : values) {
        const int exponent = value == 0 ? exponent_of_step
                                        : static_cast<int>(std::floor(std::log10(std::abs(value))));
        const int digits = std::clamp(exponent - exponent_of_step, 0, most_digits);
        texts.push_back(value == 0 ? "0" : tidied(fmt::format("{:.{}e}", value, digits)));
    }
    return texts;
}

std::string number_text(double value) {
    return tidied(fmt::format("{:.6g}", value));
}

std::optional<std::string> mistake_in_format(const std::string& format) {
    constexpr const char* expected =
        "expected one {}, {:.Nf}, {:.Ne} or {:.Ng} (N from 0 to 17) with text around it";
    const auto mistake = [&] {
        return fmt::format("found \"{}\", {}", shortened(format), expected);
    };
    const std::size_t open = format.find('{'), close = format.find('}');
    if (open == format.npos || close == format.npos || close < open) return mistake();
    if (format.find_first_of("{}", close + 1) != format.npos) return mistake();
    const std::string field = format.substr(open + 1, close - open - 1);
    if (field.find('{') != field.npos) return mistake();
    if (field.empty()) return std::nullopt;
    if (field.size() < 4 || field.size() > 5 || !field.starts_with(":.")) return mistake();
    const std::string digits = field.substr(2, field.size() - 3);
    const bool whole = digits.find_first_not_of("0123456789") == digits.npos;
    if (!whole || std::atoi(digits.c_str()) > most_digits) return mistake();
    if (std::string_view("feg").find(field.back()) == std::string_view::npos) return mistake();
    return std::nullopt;
}

std::string formatted(const std::string& format, double value) {
    const std::size_t open = format.find('{'), close = format.find('}');
    const std::string field = format.substr(open, close - open + 1);
    const std::string number =
        field == "{}" ? number_text(value) : tidied(fmt::format(fmt::runtime(field), value));
    return format.substr(0, open) + number + format.substr(close + 1);
}

}  // namespace lamina
