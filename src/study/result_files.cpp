// SPDX-License-Identifier: Apache-2.0
#include "study/result_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cassert>
#include <charconv>
#include <string_view>

#include "base/json_text.h"
#include "base/output_file.h"

namespace lamina::study {

void write_text(const std::filesystem::path& path, const std::string& text) {
    AtomicFile file(path);
    file.write(text);
    file.commit();
}

namespace {

bool is_number(const std::string& cell) {
    double number = 0;
    const char* const end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, number);
    return stop == end && error != std::errc::invalid_argument;
}

// Spreadsheets evaluate cells that begin so, which may even start programs. An apostrophe in front
// makes them text.
bool is_formula(const std::string& cell) {
    return !cell.empty() && std::string_view("=+-@\t\r").find(cell[0]) != std::string::npos &&
           !is_number(cell);
}

// RFC 4180: a cell with a comma, a quote or the end of a line is put in quotes.
std::string quoted(const std::string& cell) {
    if (is_formula(cell)) return quoted("'" + cell);
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
    if (!value.is_string()) return json_text(value);
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

nlohmann::ordered_json to_json(const ErrorNorms& norms) {
    return {{"linf", norms.linf}, {"l1", norms.mean}, {"l2", norms.l2}};
}

nlohmann::ordered_json to_json(const ImageError& error) {
    nlohmann::ordered_json channels;
    for (std::size_t i = 0; i < error.channels.size(); ++i)
        channels[error.channels[i]] = to_json(error.of_channel[i]);
    return {{"channels", channels}, {"all", to_json(error.all)}};
}

}  // namespace lamina::study
