// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lamina::study {

// The whole file at once, through AtomicFile. Throws Error.
void write_text(const std::filesystem::path& path, const std::string& text);

// Numbers in columns: a line of names, then one line a row.
class CsvTable {
  public:
    explicit CsvTable(const std::vector<std::string>& columns);
    // As many cells as columns, as text.
    void add_row(const std::vector<std::string>& cells);
    const std::string& text() const { return text_; }

  private:
    std::size_t columns_;
    std::string text_;
};

// Objects of the same keys and plain values, one a row; null is an empty cell.
std::string csv_of_rows(const nlohmann::ordered_json& rows);

}  // namespace lamina::study
