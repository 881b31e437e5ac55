// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "base/error.h"
#include "base/json_text.h"

namespace lamina {

// A value as messages have it: one short line.
inline std::string json_excerpt(const nlohmann::json& value) {
    return one_line(json_text(value).substr(0, 100));
}

}  // namespace lamina
