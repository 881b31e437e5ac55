// SPDX-License-Identifier: Apache-2.0
#include "volume_files/metaimage_fields.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "base/error.h"
#include "base/input_file.h"
#include "volume_files/whole_number.h"

namespace lamina {
namespace {

constexpr std::size_t header_limit = std::size_t{1} << 20;

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

}  // namespace

MetaImageFields::MetaImageFields(const std::filesystem::path& path) : file_(path.string()) {
    expect_regular_file(path);
    std::istringstream stream(file_beginning(path, header_limit));
    int number = 0;
    for (std::string line; !has("ElementDataFile") && std::getline(stream, line);) {
        ++number;
        if (trimmed(line).empty()) continue;
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos || line.size() > 4096) {
            fail("{}: line {}: found '{}', expected 'Key = value'", file_, number,
                 one_line(line.substr(0, 40)));
        }
        const std::string key = trimmed(line.substr(0, equals));
        if (!fields_.emplace(key, trimmed(line.substr(equals + 1))).second)
            fail("{}: line {}: second '{}'", file_, number, one_line(key.substr(0, 40)));
    }
    if (!has("ElementDataFile")) fail("{}: no ElementDataFile in the header, expected one", file_);
    length_ = stream.eof() ? -1 : static_cast<std::int64_t>(stream.tellg());
    if (!text("ElementDataFile").starts_with("LIST")) return;
    for (std::string line; std::getline(stream, line);)
        if (!trimmed(line).empty()) listed_.push_back(trimmed(line));
}

std::string MetaImageFields::text(const std::string& key, const std::string& otherwise) const {
    const auto found = fields_.find(key);
    return found == fields_.end() ? otherwise : found->second;
}

bool MetaImageFields::flag(const std::string& key, bool otherwise) const {
    const std::string word = text(key);
    if (word.empty() && !has(key)) return otherwise;
    const char letter = word.empty() ? ' ' : word[0];
    if (letter == 'T' || letter == 't' || letter == '1') return true;
    if (letter == 'F' || letter == 'f' || letter == '0') return false;
    reject(key, "True or False");
}

std::int64_t MetaImageFields::whole(const std::string& key, std::int64_t least,
                                    std::int64_t most) const {
    return wholes(key, 1, least, most)[0];
}

std::vector<std::int64_t> MetaImageFields::wholes(const std::string& key, std::size_t count,
                                                  std::int64_t least, std::int64_t most) const {
    std::vector<std::int64_t> result;
    for (const std::string& word : words_of(text(key))) {
        const auto number = whole_number(word);
        if (!number || *number < least || *number > most) break;
        result.push_back(*number);
    }
    if (result.size() != count || words_of(text(key)).size() != count)
        reject(key, fmt::format("{} whole numbers from {} to {}", count, least, most));
    return result;
}

std::vector<double> MetaImageFields::numbers(const std::string& key, std::size_t count) const {
    std::vector<double> result;
    const std::vector<std::string> words = words_of(text(key));
    for (const std::string& word : words) {
        char* end = nullptr;
        const double number = std::strtod(word.c_str(), &end);
        if (*end != '\0' || !std::isfinite(number)) break;
        result.push_back(number);
    }
    if (result.size() != count || words.size() != count)
        reject(key, fmt::format("{} finite numbers", count));
    return result;
}

void MetaImageFields::reject(const std::string& key, const std::string& expected) const {
    if (!has(key)) fail("{}: {}: found nothing, expected {}", file_, key, expected);
    fail("{}: {}: found '{}', expected {}", file_, key, one_line(text(key).substr(0, 80)),
         expected);
}

}  // namespace lamina
