// SPDX-License-Identifier: Apache-2.0
#include "study/study_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "scene_files/json_reader.h"
#include "study/report_page.h"
#include "study/result_files.h"
#include "study/run_list.h"
#include "study/study_report.h"

namespace lamina::study {
namespace {

RunList read_list(const StudyFolder& folder) {
    return run_list_from(load_json(folder.run_list()), folder.run_list());
}

void copy_whole(const std::filesystem::path& from, const std::filesystem::path& into) {
    expect_regular_file(from);
    AtomicFile copy(into);
    std::ifstream stream(from, std::ios::binary);
    std::vector<char> block(std::size_t{1} << 20);
    while (stream) {
        check_interrupt();
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        copy.write(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.eof()) fail("{}: cannot read", from.string());
    copy.commit();
}

void copy_pictures(const std::filesystem::path& from, const std::filesystem::path& into) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(from, error)) {
        const std::filesystem::path to = into / entry.path().filename();
        if (to.extension() == ".exr" && !std::filesystem::exists(to)) copy_whole(entry.path(), to);
    }
}

// Copies the references that are complete. Another shard may have one in place of a damaged one.
void copy_references(const std::filesystem::path& from, const std::filesystem::path& into,
                     const ReferenceStore::Say& say) {
    std::error_code error;
    ReferenceStore there(into, [](const std::string&) {});
    for (const auto& entry : std::filesystem::directory_iterator(from, error)) {
        const std::string id = entry.path().stem();
        if (entry.path().extension() != ".json" || there.is_kept(id)) continue;
        try {
            ReferenceStore::load(from, id);
        } catch (const Error& damage) {
            say(fmt::format("{}: the reference is left out", damage.what()));
            continue;
        }
        for (const char* const suffix : {".npy", ".json"})
            copy_whole(from / (id + suffix), into / (id + suffix));
    }
}

// Throws Error if the folder's study is not that of the list, or drew other data.
void check_list(RunList& list, const std::filesystem::path& list_of, const StudyFolder& folder) {
    const RunList other = read_list(folder);
    if (other.id() != list.id()) {
        fail("{}: holds another study, \"{}\", than {}, \"{}\"", folder.path.string(), other.title,
             list_of.string(), list.title);
    }
    match_data(list, StudyFolder(list_of).run_list().string(), other, folder.run_list().string());
}

using Journals = std::map<std::string, std::filesystem::path>;  // by name

void add_journals(const StudyFolder& folder, Journals& journals) {
    for (const auto& journal : folder.journals()) {
        expect_regular_file(journal);
        const auto [found, added] = journals.emplace(journal.filename().string(), journal);
        if (!added) {
            fail("{} and {} are the same shard: expected different ones", found->second.string(),
                 journal.string());
        }
    }
}

// Throws Error unless the journals in `into` are beginnings of these.
void check_journals(const Journals& journals, const StudyFolder& into) {
    for (const auto& [name, journal] : journals) {
        const std::filesystem::path there = into.path / name;
        if (!std::filesystem::exists(there)) continue;
        if (!read_file_bytes(journal).starts_with(read_file_bytes(there))) {
            fail("{}: holds other records than {}: expected a folder without this shard",
                 there.string(), journal.string());
        }
    }
}

}  // namespace

void merge_studies(const std::vector<std::filesystem::path>& from, const StudyFolder& into,
                   const ReferenceStore::Say& say) {
    RunList list = read_list(StudyFolder(from.front()));
    Journals journals;
    for (const std::filesystem::path& path : from) {
        check_list(list, from.front(), StudyFolder(path));
        add_journals(StudyFolder(path), journals);
    }
    if (std::filesystem::exists(into.run_list())) check_list(list, from.front(), into);
    check_journals(journals, into);
    into.make();
    // The list stays if `into` is one of the folders that are read.
    if (!std::filesystem::exists(into.run_list())) write_run_list(into, list);
    for (const std::filesystem::path& path : from) {
        const StudyFolder folder(path);
        copy_references(folder.references(), into.references(), say);
        copy_pictures(folder.pictures(), into.pictures());
    }
    for (const auto& [name, journal] : journals) {
        std::error_code ignored;
        if (!std::filesystem::equivalent(journal, into.path / name, ignored))
            copy_whole(journal, into.path / name);
    }
}

namespace {

using Json = nlohmann::ordered_json;

// A lock on a folder that several shards write into: only one at a time reads the journals and
// writes results. So the results of the last one have all records.
class FolderLock {
  public:
    explicit FolderLock(const std::filesystem::path& folder)
        : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (descriptor_ < 0) fail("{}: cannot read: {}", folder.string(), std::strerror(errno));
        // Any other errno means that the file system has no locks. Then it does not wait.
        while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
            check_interrupt();
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }
    ~FolderLock() { close(descriptor_); }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int descriptor_;
};

}  // namespace

void write_run_list(const StudyFolder& folder, const RunList& list) {
    write_text(folder.run_list(), json_text(to_json(list), 1) + "\n");
}

StudySummary write_study_output(const StudyFolder& folder) {
    const FolderLock lock(folder.path);
    const StudyResults results = read_results(folder);
    folder.own().add(StudyFolder::results());
    write_text(folder.path / "results.csv", csv_of(results));
    Json report = report_of(results);
    write_text(folder.path / "results.json", json_text(report, 1) + "\n");
    StudySummary summary{results.runs.size(), results.list.runs.size(), report["findings"], {}};
    add_pictures(folder, report);
    write_text(folder.path / "report.html", report_page(report));
    for (const RunResult& run : results.runs) {
        const StudyRun& of = results.list.runs[run.run];
        if (!run.failed.empty())
            summary.failures.push_back(fmt::format(
                "{}, {}: failed: {}", results.list.scenes[of.scene], of.name, run.failed));
    }
    return summary;
}

}  // namespace lamina::study
