// SPDX-License-Identifier: Apache-2.0
#include "volume_files/text_samples.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_word = 128;

// Cuts a stream into words of bounded length.
class WordReader {
  public:
    explicit WordReader(std::FILE* stream) : stream_(stream), buffer_(buffer_bytes) {}

    // Returns the next word, cut off beyond longest_word, or an empty one at the end of the file.
    const std::string& next() {
        word_.clear();
        int c = get();
        while (is_separator(c)) c = get();
        for (; c != EOF && !is_separator(c); c = get()) {
            if (word_.size() < longest_word) word_ += static_cast<char>(c);
        }
        return word_;
    }

  private:
    static bool is_separator(int c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); }

    int get() {
        if (at_ == filled_) {
            check_interrupt();
            filled_ = std::fread(buffer_.data(), 1, buffer_.size(), stream_);
            at_ = 0;
            if (filled_ == 0) return EOF;
        }
        return static_cast<unsigned char>(buffer_[at_++]);
    }

    std::FILE* stream_;
    std::vector<char> buffer_;
    std::size_t at_ = 0;
    std::size_t filled_ = 0;
    std::string word_;
};

// std::from_chars() also reports numbers as out of range that are nearer to 0 than any of the type.
// This parses them.
template <typename T>
bool parse_small(const char* first, const char* end, T& sample) {
    long double wide = 0;  // has a wider range of exponents
    const bool fits = std::from_chars(first, end, wide).ec == std::errc{};
    if (!fits && std::string_view(first, end).find('-', 1) == std::string_view::npos) return false;
    if (std::abs(wide) > 1) return false;
    sample = static_cast<T>(wide);
    return true;
}

template <typename T>
bool parse(const std::string& word, T& sample) {
    const char* const first = word.data() + (word[0] == '+' ? 1 : 0);
    const char* const end = word.data() + word.size();
    if constexpr (std::is_floating_point_v<T>) {
        const auto [stop, error] = std::from_chars(first, end, sample);
        if (stop != end || error == std::errc::invalid_argument) return false;
        return error == std::errc{} || parse_small(first, end, sample);
    } else if (std::from_chars(first, end, sample).ptr == end) {
        return std::from_chars(first, end, sample).ec == std::errc{};
    } else {
        double number = 0;
        const auto [stop, error] = std::from_chars(first, end, number);
        if (error != std::errc{} || stop != end || number != std::floor(number)) return false;
        if (number < static_cast<double>(std::numeric_limits<T>::min()) ||
            number >= std::ldexp(1.0, std::numeric_limits<T>::digits))
            return false;
        sample = static_cast<T>(number);
        return true;
    }
}

template <typename T>
void read_numbers(std::FILE* stream, const std::string& file, ValueType type, std::int64_t count,
                  T* samples) {
    WordReader reader(stream);
    for (std::int64_t i = 0; i < count; ++i) {
        const std::string& word = reader.next();
        if (word.empty()) fail("{}: found {} samples, expected {}", file, i, count);
        if (!parse(word, samples[i])) {
            fail("{}: sample {} of {}: found '{}', expected a {} of type {}, from {} to {}", file,
                 i + 1, count, word, std::is_floating_point_v<T> ? "number" : "whole number",
                 name_of(type), std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max());
        }
    }
    std::int64_t surplus = 0;
    while (!reader.next().empty()) ++surplus;
    if (surplus > 0) {
        warn(
            fmt::format("{}: found {} numbers or other words more than the {} of the header: they "
                        "are not used",
                        file, surplus, count));
    }
}

}  // namespace

void read_text_samples(std::FILE* stream, const std::string& file, ValueType type,
                       std::int64_t count, void* samples) {
    with_type(type, [&](auto zero) {
        read_numbers(stream, file, type, count, static_cast<decltype(zero)*>(samples));
    });
}

}  // namespace lamina
