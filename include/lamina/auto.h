// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <concepts>
#include <optional>
#include <type_traits>
#include <utility>

namespace lamina {

// Stands for "auto" in scene files.
struct Automatic {
    friend bool operator==(Automatic, Automatic) = default;
};
inline constexpr Automatic automatic;

// Holds a value of a scene that is given, or is automatic: then it is chosen once the data, the
// view or the context that it depends on are known. A value is automatic unless it is given; {}
// is automatic, too.
template <typename T>
class Auto {
  public:
    Auto() = default;
    Auto(Automatic) {}  // NOLINT(google-explicit-constructor)
    template <typename Value = T>
    requires(std::convertible_to<Value, T> && !std::same_as<std::remove_cvref_t<Value>, Auto> &&
             !std::same_as<std::remove_cvref_t<Value>, Automatic>)
        Auto(Value&& value)  // NOLINT(google-explicit-constructor)
        : given_(std::forward<Value>(value)) {}

    bool is_automatic() const { return !given_; }
    bool is_given() const { return given_.has_value(); }

    // The given value; there must be one.
    const T& operator*() const {
        assert(given_);
        return *given_;
    }
    T& operator*() {
        assert(given_);
        return *given_;
    }
    const T* operator->() const { return &**this; }
    T* operator->() { return &**this; }
    T value_or(T otherwise) const { return given_ ? *given_ : std::move(otherwise); }

    friend bool operator==(const Auto&, const Auto&) = default;
    friend bool operator==(const Auto& open, const T& value) { return open.given_ == value; }
    friend bool operator==(const Auto& open, Automatic) { return open.is_automatic(); }

  private:
    std::optional<T> given_;
};

// The word of an enum's value in scene files.
template <typename Enum>
requires(std::is_enum_v<Enum>) const char* name_of(const Auto<Enum>& value) {
    return value.is_given() ? name_of(*value) : "auto";
}

}  // namespace lamina
