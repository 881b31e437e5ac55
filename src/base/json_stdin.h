// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace lamina {

// Messages call a JSON text from stdin by this name, like a file.
inline constexpr const char* stdin_name = "stdin";

// Parses all that comes from stdin, within the limits of base/json_text.h. Error messages begin
// with stdin_name. Throws Interrupted once a stop is requested, also while nothing comes.
nlohmann::json load_json_from_stdin();

}  // namespace lamina
