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

// An attribute of an array: numbers, or a text; neither: there is none.
struct PackedAttribute {
    std::vector<double> numbers;
    std::optional<ValueType> type;  // of the numbers, as stored
    std::string text;
};

// Unpacks an array's values as its attributes of NetCDF say (CF conventions, sections 2.5.1 and
// 8.1; NetCDF Users' Guide, appendix A).
class PackedValues {
  public:
    using Attribute = std::function<PackedAttribute(const char* key)>;

    PackedValues() = default;
    // `type`: the samples', as stored. `has_defaults`: samples may have NetCDF's own fill values.
    // `name`: for messages. Throws Error.
    PackedValues(std::string name, ValueType type, bool has_defaults, const Attribute& attribute);

    // Returns the type of the samples that mark() makes.
    ValueType type() const;
    bool can_be_missing() const { return !missing_.empty() || least_ || most_; }
    double scale() const { return scale_; }
    double offset() const { return offset_; }

    // Makes floating-point numbers of `count` stored samples, in which missing ones are NaN; only
    // if can_be_missing(). Returns how many are missing.
    std::int64_t mark(std::int64_t count, const void* from, void* to) const;
    void say_missing(std::int64_t count) const;  // if it is not 0

    // Returns what stored numbers, as double of their type, stand for: scaled; NaN if missing.
    std::vector<double> meant(std::vector<double> stored) const;

  private:
    bool is_missing(double value) const;
    double turned(double value) const;
    ValueType with_sign_of(ValueType type, const PackedAttribute& told) const;
    void read_missing(ValueType type, bool has_defaults, const Attribute& attribute);
    void read_limits(const std::optional<ValueType>& packing, const Attribute& attribute);
    double noted(const char* key, double value);

    std::string name_;
    ValueType stored_ = ValueType::uint8;  // "_Unsigned" may have changed its sign
    bool is_turned_ = false;               // if it has
    double scale_ = 1, offset_ = 0;
    std::vector<double> missing_;         // values that mark missing samples
    std::optional<double> least_, most_;  // of valid samples
    std::string keys_;                    // the attributes that say so
};

}  // namespace lamina
