// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/value_type.h"

namespace lamina {

// Reads words and numbers from a text, independently of the locale.
class TextReader {
  public:
    explicit TextReader(std::string_view text)
        : begin_(text.data()), at_(begin_), end_(begin_ + text.size()) {}

    static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    // Skips blanks and newlines; returns whether the text is at its end.
    bool at_end() {
        while (at_ != end_ && is_blank(*at_)) ++at_;
        return at_ == end_;
    }
    // Tells if there is more than blanks before the next newline. Does not move, unlike line().
    bool line_goes_on() const {
        const char* at = at_;
        while (at != end_ && *at != '\n' && is_blank(*at)) ++at;
        return at != end_ && *at != '\n';
    }
    std::size_t position() const { return static_cast<std::size_t>(at_ - begin_); }
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
    const char* here() const { return at_; }
    void skip(std::size_t count) { at_ += count; }  // at most left()

    // Returns the number of the line of the last word read; the first has number 1.
    std::size_t line_number() const {
        return static_cast<std::size_t>(std::count(begin_, at_, '\n')) + 1;
    }

    // Returns the next word, or nothing at the end.
    std::string_view word() {
        if (at_end()) return {};
        const char* const first = at_;
        at_ = std::find_if(at_, end_, is_blank);
        return {first, static_cast<std::size_t>(at_ - first)};
    }

    // Returns the text from here to the newline, which is skipped.
    std::string_view line() {
        const char* const first = at_;
        const char* const stop = std::find(at_, end_, '\n');
        at_ = stop == end_ ? stop : stop + 1;
        return {first, static_cast<std::size_t>(stop - first)};
    }

    // Reads the next word as a T and moves past it; if it is no T or does not fit, returns false
    // and stays. Numbers too small for a floating-point type become 0; "nan" and "inf" are numbers.
    template <typename T>
    bool read(T& value) {
        if (at_end()) return false;
        const char* const first = *at_ == '+' ? at_ + 1 : at_;
        auto [stop, error] = std::from_chars(first, end_, value);
        if constexpr (std::is_floating_point_v<T>) {
            if (error == std::errc::result_out_of_range) {
                long double wide = 0;  // its range of exponents is larger
                const auto again = std::from_chars(first, end_, wide);
                if (again.ec == std::errc{} && std::abs(wide) < 1) {
                    value = std::copysign(T{0}, static_cast<T>(wide));
                    error = std::errc{};
                }
            }
        }
        if (error != std::errc{} || (stop != end_ && !is_blank(*stop))) return false;
        at_ = stop;
        return true;
    }

  private:
    const char* begin_;
    const char* at_;
    const char* end_;
};

// Returns the next word for messages: "'abc'", shortened if it is long, or "the end".
inline std::string next_word(TextReader reader) {
    constexpr std::size_t longest = 40;
    const std::string_view word = reader.word();
    if (word.empty()) return "the end";
    std::string text;
    for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
    return "'" + text + (word.size() > longest ? "...'" : "'");
}

// Warns that `text` is not used, unless it is blank. `behind`: names the part before the text.
inline void warn_of_surplus(const std::string& what, std::string_view text, const char* behind) {
    const auto surplus = std::ranges::count_if(text, std::not_fn(TextReader::is_blank));
    if (surplus == 0) return;
    say("{}: found {} bytes behind {}, expected none: they are not used", what, surplus, behind);
}

// Returns the name that VTK XML files give a type: "Float32".
inline const char* vtk_name_of(ValueType type) {
    static constexpr const char* names[] = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                            "UInt32", "Int64", "UInt64", "Float32", "Float64"};
    return names[static_cast<std::size_t>(type)];
}

// Reads `count` numbers of `type`. Throws Error. `what`: names the file and the array in messages.
template <typename To>
std::vector<To> read_text_values(TextReader& reader, ValueType type, std::int64_t count,
                                 const std::string& what) {
    if (static_cast<std::uint64_t>(count) > (reader.left() + 1) / 2) {  // "1 2": two bytes each
        fail("{}: found {} bytes of text, expected {} numbers", what, reader.left(), count);
    }
    return with_type(type, [&](auto value) {
        std::vector<To> values(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < values.size(); ++i) {
            if ((i & 0xfffff) == 0) check_interrupt();
            if (!reader.read(value)) {
                fail("{}: value {} of {}: found {}, expected a number ({})", what, i + 1, count,
                     next_word(reader), vtk_name_of(type));
            }
            values[i] = value_as<To>(value);
        }
        return values;
    });
}

}  // namespace lamina
