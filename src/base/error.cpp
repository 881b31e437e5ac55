// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <fmt/ranges.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>
#include <numeric>
#include <system_error>
#include <vector>

namespace lamina {

std::string one_line(const std::string& text) {
    std::string line;
    for (const char c : text) {
        const bool blank = static_cast<unsigned char>(c) <= ' ';
        if (!blank)
            line += c;
        else if (!line.empty() && line.back() != ' ')
            line += ' ';
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

namespace {

constexpr std::size_t most_of_path = 100;  // bytes of a path that a message shows

// Text before the system's reason in the std::runtime_error that oneTBB throws if it cannot start a
// thread: there is no memory for a stack, or the system allows no more threads.
constexpr std::string_view no_thread = "pthread_create has failed: ";

template <typename... Kinds>
bool is_one_of(const std::exception& error) {
    return ((dynamic_cast<const Kinds*>(&error) != nullptr) || ...);
}

unsigned byte_at(std::string_view text, std::size_t at) {
    return static_cast<unsigned char>(text[at]);
}

// Returns the length of the character that `text` begins with, or 0 if it is not valid UTF-8
// (The Unicode Standard, table 3-7: no overlong forms, no surrogates, nothing above U+10FFFF).
std::size_t character_length(std::string_view text) {
    const unsigned first = byte_at(text, 0);
    if (first < 0x80) return 1;
    const std::size_t length = first < 0xc2   ? 0
                               : first < 0xe0 ? 2
                               : first < 0xf0 ? 3
                               : first < 0xf5 ? 4
                                              : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte_at(text, i) & 0xc0) != 0x80) return 0;
    }
    const unsigned second = byte_at(text, 1);
    const bool bad = (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                     (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
    return bad ? 0 : length;
}

// Tells whether a UTF-8 character is a control: U+0000 to U+001F or U+007F to U+009F.
bool is_control(std::string_view character) {
    const unsigned first = byte_at(character, 0);
    if (character.size() == 1) return first < ' ' || first == 0x7f;
    return first == 0xc2 && byte_at(character, 1) < 0xa0;
}

// Returns how many letters are to be inserted, left out, replaced or exchanged with the next one
// (Damerau; each letter changes once).
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before, row(b.size() + 1), next(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        next[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            next[j + 1] = std::min({row[j] + (a[i] == b[j] ? 0 : 1), row[j + 1] + 1, next[j] + 1});
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
                next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
        }
        before = row;
        row.swap(next);
    }
    return row.back();
}

}  // namespace

std::string error_text(const std::exception& error) {
    if (is_one_of<Error, UsageError, Interrupted>(error)) return error.what();
    if (is_one_of<std::bad_alloc>(error)) return "out of memory";
    if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
        return fmt::format("{}: {}", shortened(file->path1().string(), most_of_path),
                           file->code().message());
    }
    if (const auto* system = dynamic_cast<const std::system_error*>(&error))
        return fmt::format("the system refuses: {}", system->code().message());
    const std::string_view text = error.what();
    if (is_one_of<std::runtime_error>(error) && text.starts_with(no_thread))
        return fmt::format("the system refuses a thread: {}", text.substr(no_thread.size()));
    return "a mistake of lamina, not of what it was given: please report this command with the "
           "files that it reads and the output of 'lamina --version'";
}

std::string printable(std::string_view text) {
    std::string shown;
    shown.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        text.remove_prefix(character.size());
        if (length > 0 && !is_control(character))
            shown += character;
        else if (character == "\n")
            shown += "\\n";
        else if (character == "\t")
            shown += "\\t";
        else
            for (const char byte : character)
                shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
    }
    return shown;
}

std::string number_text(double value, double fineness, int digits) {
    // If values differ little from each other, 1000000 is easier to compare than 1e+06.
    if (fineness < 1e-4 * std::abs(value) && std::abs(value) < 1e15)
        digits = std::max(digits, static_cast<int>(std::log10(std::abs(value))) + 1);
    std::string text = fmt::format("{:.{}g}", value, digits);
    for (int more = digits + 1; more <= std::numeric_limits<double>::max_digits10; ++more) {
        double shown = 0;
        std::from_chars(text.data(), text.data() + text.size(), shown);
        // For NaN and infinity more digits do not help.
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

std::string suggestion(const std::set<std::string>& words, const std::string& word) {
    if (words.empty()) return "";
    const auto distance = [&](const std::string& known) { return edit_distance(known, word); };
    const std::string& nearest = *std::ranges::min_element(words, {}, distance);
    if (distance(nearest) <= std::max<std::size_t>(2, word.size() / 3))
        return fmt::format(", did you mean \"{}\"?", nearest);
    return fmt::format(", expected one of {}", fmt::join(words, ", "));
}

}  // namespace lamina
