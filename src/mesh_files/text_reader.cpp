// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/text_reader.h"

#include <algorithm>
#include <functional>

#include "base/client.h"

namespace lamina {

std::size_t TextReader::line_number() const {
    return static_cast<std::size_t>(std::count(begin_, at_, '\n')) + 1;
}

std::string_view TextReader::word() {
    if (at_end()) return {};
    const char* const first = at_;
    at_ = std::find_if(at_, end_, is_blank);
    return {first, static_cast<std::size_t>(at_ - first)};
}

std::string_view TextReader::line() {
    const char* const first = at_;
    const char* const stop = std::find(at_, end_, '\n');
    at_ = stop == end_ ? stop : stop + 1;
    return {first, static_cast<std::size_t>(stop - first)};
}

std::string next_word(TextReader reader) {
    constexpr std::size_t longest = 40;
    const std::string_view word = reader.word();
    if (word.empty()) return "the end";
    std::string text;
    for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
    return "'" + text + (word.size() > longest ? "...'" : "'");
}

void warn_of_surplus(const std::string& what, std::string_view text, const char* behind) {
    const auto surplus = std::ranges::count_if(text, std::not_fn(TextReader::is_blank));
    if (surplus == 0) return;
    warn(fmt::format("{}: found {} bytes behind {}, expected none: they are not used", what,
                     surplus, behind));
}

const char* vtk_name_of(ValueType type) {
    static constexpr const char* names[] = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                            "UInt32", "Int64", "UInt64", "Float32", "Float64"};
    return names[static_cast<std::size_t>(type)];
}

}  // namespace lamina
