// SPDX-License-Identifier: Apache-2.0
#include "study/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>

#include "base/atomic_file.h"

namespace lamina {

void write_text(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

namespace {

// RFC 4180: in quotes where it holds a comma, a quote or the end of a line.
std::string quoted(const std::string& cell) {
    if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
    std::string text = "\"";
    for (const char c : cell) {
        if (c == '"') text += '"';
        text += c;
    }
    return text + '"';
}

}  // namespace

CsvTable::CsvTable(const std::vector<std::string>& columns) : columns_(columns.size()) {
    add_row(columns);
}

void CsvTable::add_row(const std::vector<std::string>& cells) {
    assert(cells.size() == columns_);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i > 0) text_ += ',';
        text_ += quoted(cells[i]);
    }
    text_ += '\n';
}

namespace {

std::string cell_of(const nlohmann::ordered_json& value) {
    if (value.is_null()) return {};
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    if (!value.is_string()) return value.dump();
    return value.get<std::string>();
}

}  // namespace

std::string csv_of_rows(const nlohmann::ordered_json& rows) {
    std::vector<std::string> names;
    for (const auto& [key, value] : rows.front().items()) names.push_back(key);
    CsvTable csv(names);
    for (const nlohmann::ordered_json& row : rows) {
        std::vector<std::string> cells;
        for (const auto& [key, value] : row.items()) cells.push_back(cell_of(value));
        csv.add_row(cells);
    }
    return csv.text();
}

}  // namespace lamina
