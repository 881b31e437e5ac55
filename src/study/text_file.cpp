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

CsvTable::CsvTable(const std::vector<std::string>& columns) : columns_(columns.size()) {
    add_row(columns);
}

void CsvTable::add_row(const std::vector<std::string>& cells) {
    assert(cells.size() == columns_);
    text_ += fmt::format("{}\n", fmt::join(cells, ","));
}

}  // namespace lamina
