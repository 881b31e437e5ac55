// SPDX-License-Identifier: Apache-2.0
#include "study/study_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <string>

#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "base/text.h"

namespace lamina::study {

std::vector<std::string> StudyFolder::names() {
    std::vector<std::string> all = results();
    for (const std::string& folder : folders()) all.push_back(folder);
    return all;
}

std::filesystem::path StudyFolder::journal(int shard, int shards) const {
    return path / fmt::format("journal-{}-of-{}.jsonl", shard, shards);
}

std::vector<std::filesystem::path> StudyFolder::journals() const {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("journal-") && name.ends_with(".jsonl")) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<std::filesystem::path> StudyFolder::kept() const {
    std::vector<std::filesystem::path> found = journals();
    found.push_back(run_list());
    for (const std::string& folder : folders()) {
        std::error_code error;
        for (const auto& entry : std::filesystem::directory_iterator(path / folder, error))
            found.push_back(entry.path());
    }
    return found;
}

void StudyFolder::make() const {
    own().add(folders());
    for (const auto& folder : {path, references(), pictures()}) make_folder(folder);
}

namespace {

struct CompleteLines {
    std::vector<nlohmann::json> records;
    std::int64_t bytes = 0;
};

// Returns null if the line is not JSON that the program reads.
nlohmann::json record_of(const std::string& line) {
    try {
        return parse_json(line);
    } catch (const Error&) {
        return nullptr;
    }
}

CompleteLines read_lines(const std::filesystem::path& path) {
    std::istringstream stream(read_file_bytes(path));
    CompleteLines lines;
    std::string line;
    // getline() meets the end of the file if the newline is missing: that line is incomplete.
    while (std::getline(stream, line) && !stream.eof()) {
        lines.records.push_back(record_of(line));
        if (!lines.records.back().is_object()) {
            fail("{}: line {}: found \"{}\", expected a record that lamina study wrote",
                 path.string(), lines.records.size(), one_line(shortened(line)));
        }
        lines.bytes += static_cast<std::int64_t>(line.size()) + 1;
    }
    return lines;
}

}  // namespace

Journal::Journal(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code ignored;
    if (std::filesystem::exists(path_, ignored)) expect_regular_file(path_);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
    try {
        // Some file systems have no locks. There nothing keeps two processes apart.
        if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            fail("{}: another lamina study is writing it", path_.string());
        CompleteLines lines = read_lines(path_);
        if (ftruncate(descriptor_, lines.bytes) != 0)
            fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
        found_ = std::move(lines.records);
    } catch (...) {
        close(descriptor_);
        throw;
    }
}

Journal::~Journal() {
    close(descriptor_);
}

void Journal::append(const nlohmann::ordered_json& record) {
    const std::string line = json_text(record) + "\n";
    std::size_t written = 0;
    while (written < line.size()) {
        const ssize_t count = write(descriptor_, line.data() + written, line.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
        written += static_cast<std::size_t>(count);
    }
    if (fdatasync(descriptor_) != 0)
        fail("{}: cannot write: {}", path_.string(), std::strerror(errno));
}

std::vector<nlohmann::json> Journal::read(const std::filesystem::path& path) {
    return read_lines(path).records;
}

}  // namespace lamina::study
