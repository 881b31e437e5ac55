// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace lamina::study {

// One HTML page that shows a report (results.json of a study or a cross-check) and opens from disk:
// share/report/page.html with its style, scripts and the report itself within. It asks no network
// for anything, and forbids the browser to. Without JavaScript it shows the title and the findings.
// Bytes that are not UTF-8 show as U+FFFD. Needs report["title"] and report["findings"].
std::string report_page(const nlohmann::ordered_json& report);

}  // namespace lamina::study
