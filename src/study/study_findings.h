// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/study_results.h"

namespace lamina::study {

// What the figures say, in sentences; every number in them is one that was measured.
std::vector<std::string> study_findings(const StudyResults& results);

}  // namespace lamina::study
