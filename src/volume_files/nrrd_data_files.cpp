// SPDX-License-Identifier: Apache-2.0
#include "volume_files/nrrd_data_files.h"

#include <teem/nrrd.h>
#include <cstdint>
#include <sstream>

#include "base/error.h"
#include "volume_files/file_pattern.h"
#include "volume_files/whole_number.h"

namespace lamina {
namespace {

class DataFileField {
  public:
    DataFileField(const std::string& path, int line, const std::string& value)
        : path_(path), line_(line), value_(value) {
        std::istringstream stream(value);
        for (std::string word; stream >> word;) words_.push_back(word);
    }

    bool is_list() const { return !words_.empty() && words_[0] == "LIST"; }
    bool is_pattern() const { return value_.find('%') != std::string::npos; }

    NrrdDataFiles list(const std::string& following) const {
        if (words_.size() > 2) reject("LIST, and the number of axes in one file");
        NrrdDataFiles files;
        if (words_.size() == 2) files.axes_each = axes_in(words_[1]);
        std::istringstream lines(following);
        for (std::string name; std::getline(lines, name);) {
            if (!name.empty() && name.back() == '\r') name.pop_back();
            if (!name.empty()) files.names.push_back(name);
        }
        if (files.names.empty())
            fail("{}: line {}: data file: found no names after LIST, expected one a line", path_,
                 line_);
        return files;
    }

    NrrdDataFiles pattern() const {
        const auto from = number(1), to = number(2), step = number(3);
        const std::optional<FilePattern> name =
            words_.empty() ? std::nullopt : file_pattern(words_[0]);
        if (!name || !from || !to || !step || words_.size() > 5)
            reject("a name with one %d or %03d in it, and first, last and step of its number");
        NrrdDataFiles files;
        if (words_.size() == 5) files.axes_each = axes_in(words_[4]);
        const auto names = names_of(*name, *from, *to, *step);
        if (!names)
            reject(fmt::format("a step from {} to {}, and at most {} files", *from, *to,
                               most_pattern_files));
        files.names = *names;
        return files;
    }

    NrrdDataFiles single() const {
        if (value_.empty() || value_ == "-" || value_.starts_with("SKIPLIST"))
            fail("{}: data file: found '{}', expected a file name", path_, value_);
        return {{value_}, {}};
    }

  private:
    std::optional<std::int64_t> number(std::size_t word) const {
        return word < words_.size() ? whole_number(words_[word]) : std::nullopt;
    }

    std::size_t axes_in(const std::string& word) const {
        const auto axes = whole_number(word);
        if (!axes || *axes < 1 || *axes > NRRD_DIM_MAX) reject("a number of axes in one file");
        return static_cast<std::size_t>(*axes);
    }

    [[noreturn]] void reject(const std::string& expected) const {
        fail("{}: line {}: data file: found '{}', expected {}", path_, line_, value_.substr(0, 80),
             expected);
    }

    std::string path_;
    int line_;
    std::string value_;
    std::vector<std::string> words_;
};

}  // namespace

NrrdDataFiles nrrd_data_files(const std::string& path, int line, const std::string& value,
                              const std::string& following) {
    const DataFileField field(path, line, value);
    if (field.is_list()) return field.list(following);
    return field.is_pattern() ? field.pattern() : field.single();
}

}  // namespace lamina
