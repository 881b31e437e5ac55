// SPDX-License-Identifier: Apache-2.0
#include "volume_files/packed_values.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/client.h"
#include "base/error.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// NetCDF's fill value of floating-point numbers that nobody has written (netcdf.h, NC_FILL_FLOAT).
constexpr float default_fill = 9.9692099683868690e+36F;

// Returns the type of as many bytes with the other meaning of the highest bit.
ValueType with_sign(ValueType type, bool has_sign) {
    return number_type(bytes_of(type), true, has_sign).value_or(type);
}

// Returns the values of an attribute as messages show them.
std::string found_text(const std::vector<double>& numbers, const std::string& words) {
    if (numbers.empty()) return fmt::format("\"{}\"", shortened(one_line(words)));
    return shortened(fmt::format("{}", fmt::join(numbers, ", ")));
}

}  // namespace

// Returns the type with the sign that "_Unsigned" gives it (NetCDF's "Best Practices", "Unsigned
// Data"). Programs write "true" and "false" with small and capital letters.
ValueType PackedValues::with_sign_of(ValueType type, const Numbers& numbers,
                                     const Text& text) const {
    const std::string words = text("_Unsigned");
    const std::vector<double> found = numbers("_Unsigned");
    if (words.empty() && found.empty()) return type;
    std::string small = words;
    for (char& letter : small)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    if (small != "true" && small != "false") {
        fail("{}: _Unsigned: found {}, expected \"true\" or \"false\"", name_,
             found_text(found, words));
    }
    return with_sign(type, small == "false");
}

PackedValues::PackedValues(std::string name, ValueType type, bool has_defaults,
                           const Numbers& numbers, const Text& text)
    : name_(std::move(name)), stored_(type) {
    if (is_integer(type)) stored_ = with_sign_of(type, numbers, text);
    const auto number = [&](const char* key, double otherwise) {
        const std::vector<double> found = numbers(key);
        const std::string words = text(key);
        if (found.empty() && words.empty()) return otherwise;
        if (found.size() != 1 || !std::isfinite(found[0])) {
            fail("{}: {}: found {}, expected one number", name_, key, found_text(found, words));
        }
        return found[0];
    };
    scale_ = number("scale_factor", 1);
    offset_ = number("add_offset", 0);
    if (scale_ == 0) fail("{}: scale_factor: found 0, expected another number", name_);

    is_turned_ = stored_ != type;
    const auto noted = [&](const char* key, double value) {
        keys_ += fmt::format("{}{} {}", keys_.empty() ? "" : ", ", key, value);
        if (type == ValueType::float32 && std::abs(value) < std::numeric_limits<float>::max())
            return static_cast<double>(static_cast<float>(value));  // as its samples are rounded
        return turned(value);  // attributes have the sign that is stored
    };
    for (const char* const key : {"_FillValue", "missing_value"}) {
        for (const double value : numbers(key))
            if (!std::isnan(value)) missing_.push_back(noted(key, value));
    }
    const auto limits = [&](const char* key, std::size_t count) {
        const std::vector<double> found = numbers(key);
        const std::string words = text(key);
        const bool is_there = !found.empty() || !words.empty();
        if (is_there && found.size() != count) {
            warn(fmt::format("{}: {}: found {}, expected {} numbers: it is not used", name_, key,
                             found_text(found, words), count));
        }
        return found.size() == count ? found : std::vector<double>();
    };
    if (const auto range = limits("valid_range", 2); !range.empty()) {
        least_ = noted("valid_range", range[0]);
        most_ = noted("to", range[1]);
    } else {
        if (const auto min = limits("valid_min", 1); !min.empty())
            least_ = noted("valid_min", min[0]);
        if (const auto max = limits("valid_max", 1); !max.empty())
            most_ = noted("valid_max", max[0]);
    }
    if (has_defaults && missing_.empty() && !is_integer(type))
        missing_.push_back(noted("NetCDF's fill value", static_cast<double>(default_fill)));
}

// Returns a number of the stored type, or of an attribute, with the sign that "_Unsigned" gives it.
double PackedValues::turned(double value) const {
    if (!is_turned_) return value;
    const double turn = std::ldexp(1.0, 8 * static_cast<int>(bytes_of(stored_)));
    if (stored_ == with_sign(stored_, false)) return value < 0 ? value + turn : value;
    return value >= turn / 2 ? value - turn : value;
}

bool PackedValues::is_missing(double value) const {
    return (least_ && value < *least_) || (most_ && value > *most_) ||
           std::ranges::find(missing_, value) != missing_.end();
}

std::vector<double> PackedValues::meant(std::vector<double> stored) const {
    for (double& value : stored) {
        value = turned(value);
        value =
            is_missing(value) ? std::numeric_limits<double>::quiet_NaN() : value * scale_ + offset_;
    }
    return stored;
}

ValueType PackedValues::type() const {
    if (!can_be_missing()) return stored_;
    const bool is_short = is_integer(stored_) && bytes_of(stored_) <= 2;  // float holds all of them
    return is_short || stored_ == ValueType::float32 ? ValueType::float32 : ValueType::float64;
}

void PackedValues::mark(std::int64_t count, bool reports, const void* from, void* to) const {
    std::int64_t marked = 0;
    with_type(stored_, [&](auto zero) {
        using Stored = decltype(zero);
        const auto* const values = static_cast<const Stored*>(from);
        const auto mark_as = [&](auto* results) {
            using Result = std::remove_pointer_t<decltype(results)>;
            for (std::int64_t i = 0; i < count; ++i) {
                const auto value = static_cast<double>(values[i]);
                const bool missing = is_missing(value);
                marked += missing;
                results[i] =
                    missing ? std::numeric_limits<Result>::quiet_NaN() : static_cast<Result>(value);
            }
        };
        if (type() == ValueType::float32)
            mark_as(static_cast<float*>(to));
        else
            mark_as(static_cast<double*>(to));
    });
    if (reports && marked > 0) {
        warn(fmt::format("{}: {} samples are NaN: the file calls them missing ({})", name_, marked,
                         keys_));
    }
}

}  // namespace lamina
