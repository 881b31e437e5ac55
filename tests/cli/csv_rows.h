// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamina {

using CsvRow = std::map<std::string, std::string>;  // cells by the name of their column

// Returns the cells of a CSV table (RFC 4180), line by line.
inline std::vector<std::vector<std::string>> csv_cells(const std::string& text) {
    std::vector<std::vector<std::string>> lines(1, std::vector<std::string>(1));
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        std::string& cell = lines.back().back();
        if (text[i] == '"') {
            if (quoted && i + 1 < text.size() && text[i + 1] == '"')
                cell += text[++i];
            else
                quoted = !quoted;
        } else if (!quoted && text[i] == ',') {
            lines.back().emplace_back();
        } else if (!quoted && text[i] == '\n') {
            lines.emplace_back(1);
        } else {
            cell += text[i];
        }
    }
    lines.pop_back();  // the empty line after the last line end
    return lines;
}

// Returns the rows below the line of names. Throws if a row has more or fewer cells than that line.
inline std::vector<CsvRow> csv_rows(const std::string& text) {
    const std::vector<std::vector<std::string>> lines = csv_cells(text);
    std::vector<CsvRow> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        if (lines[i].size() != lines[0].size()) throw std::runtime_error("a row of another length");
        CsvRow& row = rows.emplace_back();
        for (std::size_t j = 0; j < lines[i].size(); ++j) row[lines[0][j]] = lines[i][j];
    }
    return rows;
}

}  // namespace lamina
