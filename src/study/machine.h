// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

namespace lamina::study {

// {machine, processors, date}: the processor's name, how many of them this process may run on, and
// today (UTC).
nlohmann::ordered_json describe_machine();

}  // namespace lamina::study
