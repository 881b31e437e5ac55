// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/error.h"

namespace lamina {

// Limits that every JSON text is held to while it is parsed.
inline constexpr std::uintmax_t most_json_bytes = 64u << 20;
inline constexpr std::size_t most_json_depth = 64;  // lists and objects in each other
inline constexpr std::size_t most_json_values = 10'000'000;

class JsonSyntaxError : public Error {
  public:
    using Error::Error;
};

// The document of a text. Nothing else parses what a user can write: time and memory are
// proportional to the text's length, and signals are heard (throws Interrupted). Throws
// JsonSyntaxError, and Error where a key stands twice in one object or a limit is passed; both say
// line and column.
nlohmann::json parse_json(std::string_view text);

// The document of a file; errors begin with its name.
nlohmann::json load_json(const std::filesystem::path& file);

// `json` as a file or a message has it. Names of files and of what is in them, and words of the
// command line, may be of any encoding: bytes that are not UTF-8 become U+FFFD.
template <typename Json>
std::string json_text(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lamina
