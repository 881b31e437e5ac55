// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lamina::study {

// One HTML page that shows a report (results.json of a study or a cross-check) and can be opened
// from disk. It contains share/report/page.html with its style, its scripts and the report. It
// makes no network requests and forbids the browser to make any. Without JavaScript it shows the
// title and the findings. Bytes that are not UTF-8 are shown as U+FFFD. The report must have
// report["title"] and report["findings"].
std::string report_page(const nlohmann::ordered_json& report);

}  // namespace lamina::study
