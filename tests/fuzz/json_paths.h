// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "scratch_folder.h"

namespace lamina::fuzz {

// Tells whether all strings of a document, taken as paths, stay in the scratch folder. load_json()
// must have accepted it.
inline bool paths_stay_in_folder(const nlohmann::json& document) {
    if (document.is_string()) return stays_in_folder(document.get_ref<const std::string&>());
    if (!document.is_structured()) return true;
    return std::all_of(document.begin(), document.end(), paths_stay_in_folder);
}

}  // namespace lamina::fuzz
