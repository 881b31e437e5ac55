// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lamina::study {

// One HTML page that shows a report (results.json of a study or a cross-check) and can be opened
// from disk. It contains share/report/page.html with its style, its scripts and the report. It
// makes no network requests and forbids the browser to make any. Without JavaScript it shows the
// title, the summary and the findings. Bytes that are not UTF-8 are shown as U+FFFD, and control
// characters as \n, \t and \xNN (base/text.h). The report must have report["title"] and
// report["findings"]: a list of strings, or of {anchor, text} where the name of a section leads to
// it
// (`anchor` of a comparison: letters, digits and _). report["summary"] is one line above them,
// which may be missing.
std::string report_page(const nlohmann::ordered_json& report);

}  // namespace lamina::study
