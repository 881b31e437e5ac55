// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "image/metrics.h"

namespace lamina::study {

// {linf, l1, l2}, in 1/255.
nlohmann::ordered_json to_json(const ErrorNorms& norms);

// {channels: {R: norms, ...}, all: norms}, as `lamina compare --json` prints it.
nlohmann::ordered_json to_json(const ImageError& error);

}  // namespace lamina::study
