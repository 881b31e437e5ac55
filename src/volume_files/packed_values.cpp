// SPDX-License-Identifier: Apache-2.0
#include "volume_files/packed_values.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/error.h"
#include "volume_files/numbered_files.h"
#include "volume_files/stored_samples.h"

namespace lamina {
namespace {

// Returns NetCDF's fill value of samples that nobody has written, rounded to double (netcdf.h,
// NC_FILL_SHORT and others); nothing for bytes, all of whose values count.
std::optional<double> default_fill(ValueType type) {
    const int bits = 8 * static_cast<int>(bytes_of(type));
    if (bits == 8) return {};
    if (!is_integer(type)) return 0x1.ep122;
    return name_of(type)[0] == 'u' ? std::ldexp(1.0, bits) - 1 : 1 - std::ldexp(1.0, bits - 1);
}

// Returns the type of as many bytes with the other meaning of the highest bit.
ValueType with_sign(ValueType type, bool has_sign) {
    return number_type(bytes_of(type), true, has_sign).value_or(type);
}

// Returns an attribute's value as messages show it.
std::string found_text(const PackedAttribute& found) {
    if (found.numbers.empty()) return fmt::format("\"{}\"", shortened(one_line(found.text)));
    return shortened(fmt::format("{}", fmt::join(found.numbers, ", ")));
}

bool is_there(const PackedAttribute& found) {
    return !found.numbers.empty() || !found.text.empty();
}

}  // namespace

// Returns the type with the sign that "_Unsigned" gives it (NetCDF's "Best Practices", "Unsigned
// Data"). Programs write "true" and "false" with small and capital letters.
ValueType PackedValues::with_sign_of(ValueType type, const PackedAttribute& told) const {
    if (!is_there(told)) return type;
    const std::string small = lower_case(told.text);
    if (small != "true" && small != "false") {
        fail("{}: _Unsigned: found {}, expected \"true\" or \"false\"", name_, found_text(told));
    }
    return with_sign(type, small == "false");
}

PackedValues::PackedValues(std::string name, ValueType type, bool has_defaults,
                           const Attribute& attribute)
    : name_(std::move(name)), stored_(type) {
    if (is_integer(type)) stored_ = with_sign_of(type, attribute("_Unsigned"));
    is_turned_ = stored_ != type;
    std::optional<ValueType> packing;  // the wider type of both
    const auto number = [&](const char* key, double otherwise) {
        const PackedAttribute found = attribute(key);
        if (!is_there(found)) return otherwise;
        if (found.numbers.size() != 1 || !std::isfinite(found.numbers[0])) {
            fail("{}: {}: found {}, expected one number", name_, key, found_text(found));
        }
        packing = std::max(packing, found.type);
        return found.numbers[0];
    };
    scale_ = number("scale_factor", 1);
    offset_ = number("add_offset", 0);
    if (scale_ == 0) fail("{}: scale_factor: found 0, expected another number", name_);
    read_missing(type, has_defaults, attribute);
    read_limits(packing, attribute);
}

// Notes an attribute for messages; returns its number as samples are stored.
double PackedValues::noted(const char* key, double value) {
    keys_ += fmt::format("{}{} {}", keys_.empty() ? "" : ", ", key, value);
    if (stored_ == ValueType::float32 && std::abs(value) < std::numeric_limits<float>::max())
        return static_cast<double>(static_cast<float>(value));  // as its samples are rounded
    return turned(value);  // attributes have the sign that is stored
}

void PackedValues::read_missing(ValueType type, bool has_defaults, const Attribute& attribute) {
    for (const char* const key : {"_FillValue", "missing_value"}) {
        PackedAttribute found = attribute(key);
        if (found.numbers.empty() && !found.text.empty()) {  // a number as text
            const auto number = number_in<double>(found.text);
            if (!number)
                fail("{}: {}: found \"{}\", expected a number", name_, key,
                     shortened(one_line(found.text)));
            found.numbers = {*number};
        }
        has_defaults &= key != std::string_view("_FillValue") || found.numbers.empty();
        for (const double value : found.numbers)
            if (!std::isnan(value)) missing_.push_back(noted(key, value));
    }
    if (const auto fill = default_fill(type); fill && has_defaults)
        missing_.push_back(noted("NetCDF's fill value", *fill));
}

// Reads the limits of valid samples. They are packed as samples are, unless their type is the wider
// one of scale_factor and add_offset (`packing`) and wider than that of the samples (NetCDF Users'
// Guide, appendix A, "valid_range").
void PackedValues::read_limits(const std::optional<ValueType>& packing,
                               const Attribute& attribute) {
    const auto limits = [&](const char* key, std::size_t count) {
        PackedAttribute found = attribute(key);
        if (is_there(found) && found.numbers.size() != count) {
            say("{}: {}: found {}, expected {} numbers: it is not used", name_, key,
                found_text(found), count);
            found.numbers.clear();
        }
        return found;
    };
    const auto set = [&](const PackedAttribute& found, std::size_t i, const char* key, bool least) {
        double limit = noted(key, found.numbers[i]);
        if (found.type == packing && packing > stored_) {
            limit = (found.numbers[i] - offset_) / scale_;
            if (is_integer(stored_)) limit = std::round(limit);  // as samples are packed
            least ^= scale_ < 0;
        }
        (least ? least_ : most_) = limit;
    };
    if (const auto range = limits("valid_range", 2); !range.numbers.empty()) {
        set(range, 0, "valid_range", true);
        set(range, 1, "to", false);
        return;
    }
    if (const auto min = limits("valid_min", 1); !min.numbers.empty())
        set(min, 0, "valid_min", true);
    if (const auto max = limits("valid_max", 1); !max.numbers.empty())
        set(max, 0, "valid_max", false);
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

std::int64_t PackedValues::mark(std::int64_t count, const void* from, void* to) const {
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
    return marked;
}

void PackedValues::say_missing(std::int64_t count) const {
    if (count > 0) {
        say("{}: {} samples are NaN: the file calls them missing ({})", name_, count, keys_);
    }
}

}  // namespace lamina
