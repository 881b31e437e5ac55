// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>
#include "base/error.h"

namespace lamina {

// Limits that are checked while a JSON text is parsed.
inline constexpr std::uintmax_t most_json_bytes = 64u << 20;
inline constexpr std::size_t most_json_depth = 64;  // nesting of lists and objects
inline constexpr std::size_t most_json_values = 10'000'000;

class JsonSyntaxError : public Error {
  public:
    using Error::Error;
};

// Parses JSON from users in linear time and memory. Throws Interrupted once a stop is requested,
// JsonSyntaxError, and Error (line, column) if an object has a key twice or a limit is exceeded.
nlohmann::json parse_json(std::string_view text);

// Parses a JSON file. Error messages begin with its name.
nlohmann::json load_json(const std::filesystem::path& file);

// Returns `json` as text for a file or a message. Names of files, names inside files, and words of
// the command line may have any encoding; bytes that are not UTF-8 become U+FFFD.
template <typename Json>
std::string json_text(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// The name of a JSON text from stdin in messages, in place of a file's.
inline constexpr const char* stdin_name = "stdin";

// Parses all that comes from stdin, within the limits above. Error messages begin with stdin_name.
// Throws Interrupted once a stop is requested, also while nothing comes.
nlohmann::json load_json_from_stdin();

}  // namespace lamina
