// SPDX-License-Identifier: Apache-2.0
#include "study/study_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/client.h"
#include "base/error.h"
#include "base/json_text.h"
#include "study/report_page.h"
#include "study/study_report.h"
#include "study/text_file.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

// Of several shards that write into one folder only one at a time reads the journals and writes
// results. So the results of the last one have all records.
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
