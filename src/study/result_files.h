// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/difference.h"

namespace lamina::study {

// Writes the whole file at once, through AtomicFile. Throws Error.
void write_text(const std::filesystem::path& path, const std::string& text);

// A table in CSV: a line of names, then one line for each row.
class CsvTable {
  public:
    explicit CsvTable(const std::vector<std::string>& columns);
    // Adds a row with as many cells as columns, as text.
    void add_row(const std::vector<std::string>& cells);
    const std::string& text() const { return text_; }

  private:
    std::size_t columns_;
    std::string text_;
};

// Returns a CSV table of objects with the same keys and plain values, one row each; null is an
// empty cell.
std::string csv_of_rows(const nlohmann::ordered_json& rows);

// Returns norms as {linf, l1, l2}, in 1/255.
nlohmann::ordered_json to_json(const ErrorNorms& norms);

// Returns errors as {channels: {R: norms, ...}, all: norms}, as `lamina compare --json` prints
// them.
nlohmann::ordered_json to_json(const ImageError& error);

}  // namespace lamina::study
