// SPDX-License-Identifier: Apache-2.0
#include "series_record.h"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/content_hash.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "image/film_file.h"

namespace lamina {
namespace {

[[noreturn]] void reject(const std::string& pattern, const std::string& found) {
    throw UsageError(
        fmt::format("-o {}: {}, expected one number, as in out_%04d.png, in the name of the file, "
                    "or a film ({})",
                    pattern, found, film_suffixes));
}

// Returns the directive that begins with the percent sign at `at`: "%%", or a number like "%04d".
std::string directive_at(const std::string& pattern, std::size_t at) {
    std::size_t end = at + 1;
    if (pattern[end] == '%') return "%%";
    if (pattern[end] == '0') {
        const auto digit = [&] { return std::isdigit(static_cast<unsigned char>(pattern[end])); };
        ++end;
        if (digit() && pattern[end] != '0') ++end;
        if (end != at + 3) end = at + 1;  // "%0d" has no number of digits
    }
    if (pattern[end] != 'd')
        reject(pattern, fmt::format("found \"{}\"", pattern.substr(at, end - at + 1)));
    return pattern.substr(at, end - at + 1);
}

using Hashes = std::map<std::string, std::string>;

bool is_record(const nlohmann::json& document, const std::string& key) {
    return document.is_object() && document.value("key", nlohmann::json()) == nlohmann::json(key);
}

Hashes hashes_in(const nlohmann::json& document) {
    const nlohmann::json frames = document.value("frames", nlohmann::json::object());
    Hashes hashes;
    for (const auto& [name, hash] : frames.items()) {
        if (hash.is_string()) hashes.emplace(name, hash.get<std::string>());
    }
    return hashes;
}

std::string entry(const std::string& hash, const std::string& input) {
    return input.empty() ? hash : hash + " " + input;
}

}  // namespace

FrameNames::FrameNames(const std::string& pattern) {
    const std::size_t name_start = pattern.rfind('/') + 1;  // 0 if there is no folder
    std::string folder, before, after;
    bool numbered = false;
    for (std::size_t at = 0; at < pattern.size();) {
        std::string& text = at < name_start ? folder : numbered ? after : before;
        if (pattern[at] != '%') {
            text += pattern[at++];
            continue;
        }
        const std::string directive = directive_at(pattern, at);
        at += directive.size();
        if (directive == "%%") {
            text += '%';
            continue;
        }
        if (numbered) reject(pattern, "found several numbers");
        if (at <= name_start) reject(pattern, "found a number in the name of the folder");
        numbered = true;
        digits_ = directive.size() > 2 ? directive[2] - '0' : 0;
    }
    if (!numbered) reject(pattern, "found no number");
    folder_ = folder;
    before_ = before;
    after_ = after;
}

std::string FrameNames::name(int frame) const {
    return fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

std::string FrameNames::record_name(const char* series) const {
    return std::filesystem::path(before_ + series + after_).replace_extension(".json").string();
}

Client finishing_client() {
    Client client = ClientScope::current();
    client.stop = {};
    return client;
}

SeriesRecord::SeriesRecord(std::filesystem::path file, std::string key)
    : file_(std::move(file)), key_(std::move(key)) {
    if (!std::filesystem::exists(file_)) return;
    try {
        const nlohmann::json document = load_json(file_);
        matches_ = is_record(document, key_);
        if (matches_) hashes_ = hashes_in(document);
    } catch (const Error&) {
        matches_ = false;  // everything is drawn again
        hashes_.clear();
    }
}

void SeriesRecord::expect_match() const {
    if (matches_) return;
    fail(
        "{}: its frames are of another scene, data, options or program than --resume asks for: "
        "expected equal ones, or --force to draw all frames anew",
        file_.string());
}

bool SeriesRecord::has(const std::string& name, const std::string& input) const {
    const auto found = hashes_.find(name);
    if (found == hashes_.end()) return false;
    const std::filesystem::path path = file_.parent_path() / name;
    const OwnFilesScope own;
    return std::filesystem::is_regular_file(path) &&
           entry(hash_of_file(path), input) == found->second;
}

void SeriesRecord::add(const std::string& name, const std::string& input) {
    const ClientScope scope(finishing_client());
    const OwnFilesScope own;
    hashes_[name] = entry(hash_of_file(file_.parent_path() / name), input);
    if (since_written_.seconds() > 1) write();
}

void SeriesRecord::write() {
    AtomicFile file(file_);
    file.write(json_text(nlohmann::json{{"key", key_}, {"frames", hashes_}}, 2) + "\n");
    file.commit();
    since_written_ = {};
}

}  // namespace lamina
