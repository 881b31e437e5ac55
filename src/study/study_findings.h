// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "study/study_results.h"

namespace lamina::study {

// The results of a study as sentences. Every number in them was measured.
std::vector<std::string> study_findings(const StudyResults& results);

}  // namespace lamina::study
