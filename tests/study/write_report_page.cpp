// SPDX-License-Identifier: Apache-2.0
// write_report_page REPORT.json PAGE.html: writes the page of a report, for the test in a browser.
#include <cstdio>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "study/report_files.h"

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs("usage: write_report_page REPORT.json PAGE.html\n", stderr);
        return 2;
    }
    try {
        std::ifstream file(argv[1]);
        const auto report = nlohmann::ordered_json::parse(file);
        lamina::study::write_text(argv[2], lamina::study::report_page(report));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "write_report_page: %s\n", error.what());
        return 1;
    }
    return 0;
}
