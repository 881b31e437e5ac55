// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace lamina {

// `text` in a form that a terminal shows without executing it. Control characters (also those of
// two bytes, which some terminals obey) and bytes that are not UTF-8 become \n, \t or \xNN. Names
// of files and names inside files may contain any bytes.
std::string printable(std::string_view text);

}  // namespace lamina
