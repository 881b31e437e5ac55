// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace lamina {

// `text` as a terminal can show it without being told to do something: control characters (also
// those of two bytes, which some terminals obey) and bytes that are not UTF-8 become \n, \t or
// \xNN. Names of files and of what is in them may hold any bytes.
std::string printable(std::string_view text);

}  // namespace lamina
