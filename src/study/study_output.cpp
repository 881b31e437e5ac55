// SPDX-License-Identifier: Apache-2.0
#include "study/study_output.h"

#include <fmt/format.h>

#include "study/report_page.h"
#include "study/study_findings.h"
#include "study/study_report.h"
#include "study/text_file.h"

namespace lamina {

void write_run_list(const StudyFolder& folder, const RunList& list) {
    write_text(folder.run_list(), to_json(list).dump(1) + "\n");
}

StudySummary write_study_output(const StudyFolder& folder) {
    const StudyResults results = read_results(folder);
    write_text(folder.path / "results.csv", csv_of(results));
    write_text(folder.path / "results.json", report_of(results).dump(1) + "\n");
    write_text(folder.path / "report.html", report_page(report_with_pictures(results, folder)));
    StudySummary summary{
        results.runs.size(), results.list.runs.size(), study_findings(results), {}};
    for (const RunResult& run : results.runs) {
        const StudyRun& of = results.list.runs[run.run];
        if (!run.failed.empty())
            summary.failures.push_back(fmt::format(
                "{}, {}: failed: {}", results.list.scenes[of.scene], of.name, run.failed));
    }
    return summary;
}

}  // namespace lamina
