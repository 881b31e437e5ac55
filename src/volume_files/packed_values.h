// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/value_type.h"

namespace lamina {

// Unpacks an array's values as its attributes of NetCDF say (CF conventions, sections 2.5.1 and
// 8.1).
class PackedValues {
  public:
    // Return the numbers and the text of an attribute, or none.
    using Numbers = std::function<std::vector<double>(const char* key)>;
    using Text = std::function<std::string(const char* key)>;

    PackedValues() = default;
    // `type`: the samples', as stored. `has_defaults`: floats may have NetCDF's own fill value,
    // too. `name`: for messages. Throws Error.
    PackedValues(std::string name, ValueType type, bool has_defaults, const Numbers& numbers,
                 const Text& text);

    // Returns the type of the samples that mark() makes.
    ValueType type() const;
    bool can_be_missing() const { return !missing_.empty() || least_ || most_; }
    double scale() const { return scale_; }
    double offset() const { return offset_; }

    // Makes floating-point numbers of `count` stored samples, in which missing ones are NaN; only
    // if can_be_missing(). If `reports`, warns of missing ones and counts them.
    void mark(std::int64_t count, bool reports, const void* from, void* to) const;

    // Returns what stored numbers, as double of their type, stand for: scaled; NaN if missing.
    std::vector<double> meant(std::vector<double> stored) const;

  private:
    bool is_missing(double value) const;
    double turned(double value) const;
    ValueType with_sign_of(ValueType type, const Numbers& numbers, const Text& text) const;

    std::string name_;
    ValueType stored_ = ValueType::uint8;  // "_Unsigned" may have changed its sign
    bool is_turned_ = false;               // if it has
    double scale_ = 1, offset_ = 0;
    std::vector<double> missing_;         // values that mark missing samples
    std::optional<double> least_, most_;  // of valid samples
    std::string keys_;                    // the attributes that say so
};

}  // namespace lamina
