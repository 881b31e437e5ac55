// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "image/difference.h"

namespace lamina::study {

// Norms as {linf, l1, l2}, in 1/255.
nlohmann::ordered_json to_json(const ErrorNorms& norms);

// Errors as {channels: {R: norms, ...}, all: norms}, as `lamina compare --json` prints them.
nlohmann::ordered_json to_json(const ImageError& error);

}  // namespace lamina::study
