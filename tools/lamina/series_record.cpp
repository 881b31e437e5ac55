// SPDX-License-Identifier: Apache-2.0
#include "series_record.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "base/content_hash.h"
#include "base/json_text.h"
#include "base/output_file.h"

namespace lamina {
namespace {

using Hashes = std::map<std::string, std::string>;

// Returns nothing if the document is not a record of this key.
Hashes hashes_in(const nlohmann::json& document, const std::string& key) {
    if (!document.is_object() || document.value("key", nlohmann::json()) != nlohmann::json(key))
        return {};
    const nlohmann::json frames = document.value("frames", nlohmann::json::object());
    Hashes hashes;
    for (const auto& [name, hash] : frames.items()) {
        if (hash.is_string()) hashes.emplace(name, hash.get<std::string>());
    }
    return hashes;
}

}  // namespace

Client finishing_client() {
    Client client = ClientScope::current();
    client.stop = {};
    return client;
}

SeriesRecord::SeriesRecord(std::filesystem::path file, std::string key)
    : file_(std::move(file)), key_(std::move(key)) {
    if (!std::filesystem::exists(file_)) return;
    try {
        hashes_ = hashes_in(load_json(file_), key_);
    } catch (const Error&) {
        hashes_.clear();  // all of the series is drawn again
    }
}

namespace {

std::string entry(const std::string& hash, const std::string& input) {
    return input.empty() ? hash : hash + " " + input;
}

}  // namespace

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
