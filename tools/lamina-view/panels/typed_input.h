// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace lamina::view {

// Input fields, as wide as SetNextItemWidth() says. They return true, and change the value, once
// Enter, Tab or a click elsewhere ends the input.
bool typed_number(const char* id, double& number);
bool typed_text(const char* id, const char* hint, std::string& text);

}  // namespace lamina::view
