// SPDX-License-Identifier: Apache-2.0
#include "study/study_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <thread>
#include <utility>

#include "base/arithmetic.h"
#include "base/client.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/json_text.h"
#include "base/output_file.h"
#include "image/difference.h"
#include "image/exr.h"
#include "scene_files/keys.h"
#include "study/report_files.h"
#include "study/tree_advice.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;
using Runs = std::vector<const RunResult*>;

double ms_of(const RunResult& run) {
    return median(run.frame_ms);
}

std::string describe(const RunList& list, const RunResult& run) {
    return fmt::format("{} ({:.3g} ms, L2 {:.3g}, Linf {:.3g})", list.runs[run.run].name,
                       ms_of(run), run.all.l2, run.all.linf);
}

std::string times(double ratio) {
    return ratio >= 1 ? fmt::format("{:.2f} times the time", ratio)
                      : fmt::format("{:.2f} of the time", ratio);
}

void tell_front(const RunList& list, const std::string& scene, const Runs& runs,
                std::vector<std::string>& findings) {
    Runs front;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(front),
                 [](const RunResult* run) { return run->pareto; });
    std::sort(front.begin(), front.end(),
              [](const RunResult* a, const RunResult* b) { return ms_of(*a) < ms_of(*b); });
    const std::string ends =
        front.size() == 1
            ? fmt::format("{} is both the fastest and the most exact",
                          describe(list, *front.front()))
            : fmt::format("from the fastest, {}, to the most exact, {}",
                          describe(list, *front.front()), describe(list, *front.back()));
    findings.push_back(
        fmt::format("{}: {} of {} runs are on the Pareto front of time and L2 error: {}.", scene,
                    front.size(), runs.size(), ends));
}

void tell_baseline(const RunList& list, const std::string& scene, const Runs& runs,
                   const StudyRun& baseline, std::vector<std::string>& findings) {
    const auto is_baseline = [&](const RunResult* run) {
        return list.runs[run->run].id == baseline.id;
    };
    const auto found = std::find_if(runs.begin(), runs.end(), is_baseline);
    if (found == runs.end()) return;
    const RunResult& base = **found;
    const auto by_error = [](const RunResult* a, const RunResult* b) {
        return a->all.l2 < b->all.l2;
    };
    const RunResult& best = **std::min_element(runs.begin(), runs.end(), by_error);
    const RunResult& worst = **std::max_element(runs.begin(), runs.end(), by_error);
    std::string text = fmt::format("{}: the baseline is {}", scene, describe(list, base));
    for (const auto& [word, run] : {std::pair("least", &best), {"largest", &worst}}) {
        if (run == &base || !run->ratio) continue;
        text += fmt::format("; the {} L2 error has {}, in {}", word, describe(list, *run),
                            times(*run->ratio));
    }
    findings.push_back(text + ".");
}

void tell_limits(const std::string& scene, const Runs& runs, std::vector<std::string>& findings) {
    const auto near = std::count_if(runs.begin(), runs.end(),
                                    [](const RunResult* run) { return run->near_reference(); });
    if (near > 0) {
        findings.push_back(fmt::format(
            "{}: {} of {} runs have Linf errors below ten times the reference's own estimate: "
            "their errors are not told apart.",
            scene, near, runs.size()));
    }
}

// Returns the runs of one scene that did not fail.
Runs runs_of(const StudyResults& results, std::size_t scene) {
    Runs runs;
    for (const RunResult& result : results.runs) {
        if (results.list.runs[result.run].scene == scene && result.failed.empty())
            runs.push_back(&result);
    }
    return runs;
}

void tell_failed(const StudyResults& results, std::size_t scene,
                 std::vector<std::string>& findings) {
    const auto failed =
        std::count_if(results.runs.begin(), results.runs.end(), [&](const RunResult& result) {
            return results.list.runs[result.run].scene == scene && !result.failed.empty();
        });
    if (failed > 0)
        findings.push_back(fmt::format("{}: {} run{} failed.", results.list.scenes[scene], failed,
                                       failed == 1 ? "" : "s"));
}

// Returns the results of a study as sentences. All their numbers are measured.
std::vector<std::string> study_findings(const StudyResults& results) {
    const RunList& list = results.list;
    std::vector<std::string> findings;
    // The trees to choose answer the study's question, so they come first, and comparisons of all
    // runs after them.
    for (const bool in_floats : {false, true}) {
        for (std::size_t scene = 0; scene < list.scenes.size(); ++scene) {
            for (std::string& finding :
                 tree_findings(list, list.scenes[scene], runs_of(results, scene), in_floats))
                findings.push_back(std::move(finding));
        }
    }
    for (std::size_t scene = 0; scene < list.scenes.size(); ++scene) {
        const Runs runs = runs_of(results, scene);
        if (!runs.empty()) {
            tell_front(list, list.scenes[scene], runs, findings);
            tell_baseline(list, list.scenes[scene], runs, list.runs[list.baselines[scene]],
                          findings);
            tell_limits(list.scenes[scene], runs, findings);
        }
        tell_failed(results, scene, findings);
    }
    if (results.environment.at("machine").get<std::string>().find("; ") != std::string::npos) {
        findings.emplace_back(
            "The runs are of several machines: their times can be compared as ratios only.");
    }
    if (results.runs.size() < list.runs.size()) {
        findings.push_back(
            fmt::format("{} of {} runs are finished.", results.runs.size(), list.runs.size()));
    }
    return findings;
}

Json times_to_json(const std::vector<double>& times) {
    const auto [least, most] = std::minmax_element(times.begin(), times.end());
    return {{"median", median(times)}, {"min", *least}, {"max", *most}, {"n", times.size()}};
}

Json run_to_json(const RunList& list, const RunResult& result) {
    const StudyRun& run = list.runs[result.run];
    Json json{{"id", run.id}, {"name", run.name}, {"keys", settings_json(run.settings)}};
    if (!result.failed.empty()) {
        json["failed"] = result.failed;
        return json;
    }
    json["reference"] = result.reference;
    json["frame_ms"] = times_to_json(result.frame_ms);
    json["still_ms"] = times_to_json(result.still_ms);
    json["first_ms"] = result.first_ms ? Json(*result.first_ms) : Json();
    json["ratio"] = result.ratio ? Json(*result.ratio) : Json();
    json.update(to_json(result.all));
    for (const auto& [channel, norms] : result.channels) json["channels"][channel] = to_json(norms);
    json["stages"] = result.stages_ms;
    json["bytes_gpu"] = result.bytes_gpu;
    json["bytes_host"] = result.bytes_host;
    json["bytes"] = result.bytes_gpu + result.bytes_host;
    json["pareto"] = result.pareto;
    json["near_reference"] = result.near_reference();
    json["context"] = result.renderer;
    return json;
}

// Returns the value at the end of the colour bar of all differences of a scene: the median of the
// runs' Linf errors. Half of the pictures are then shown unclipped, and the rest clipped where they
// are worst.
double difference_scale(const Runs& runs) {
    std::vector<double> largest;
    for (const RunResult* const run : runs) {
        if (run->failed.empty() && run->all.linf > 0) largest.push_back(run->all.linf);
    }
    return largest.empty() ? 1 : median(largest);
}

Json comparison_of(const StudyResults& results, std::size_t scene) {
    Runs runs;
    for (const RunResult& result : results.runs) {
        if (results.list.runs[result.run].scene == scene) runs.push_back(&result);
    }
    Json json{{"scene", results.list.scenes[scene]},
              {"set", settings_json(results.list.own[scene])},
              {"baseline", results.list.runs[results.list.baselines[scene]].id},
              {"difference_scale", difference_scale(runs)},
              {"references", Json::array()},
              {"runs", Json::array()},
              {"plots", tree_plots(results.list, runs)}};
    for (const RunResult* const run : runs) {
        json["runs"].push_back(run_to_json(results.list, *run));
        const auto has_it = [&](const Json& reference) {
            return reference["id"] == run->reference;
        };
        Json& references = json["references"];
        if (!run->failed.empty() || std::any_of(references.begin(), references.end(), has_it))
            continue;
        references.push_back({{"id", run->reference}, {"error_estimate", run->reference_error}});
    }
    return json;
}

// Adds the pictures of a comparison's runs, references and differences, as data URIs.
void add_pictures(Json& comparison, const StudyFolder& folder) {
    std::map<std::string, Reference> references;
    for (Json& each : comparison["references"]) {
        Reference reference = ReferenceStore::load(folder.references(), each["id"]);
        each["of"] = name_of(reference.of);
        each["ms"] = reference.ms;
        each["width"] = reference.image.width;
        each["height"] = reference.image.height;
        references[each["id"]] = std::move(reference);
    }
    // Colour space of the runs that were compared with each reference.
    std::map<std::string, ImageColorSpace> spaces;
    for (Json& run : comparison["runs"]) {
        if (run.contains("failed")) continue;
        const std::filesystem::path file = folder.picture(run["id"]);
        const Image image = read_exr(file);
        const ImageColorSpace space = spaces[run["reference"]] = color_space_of_exr(file);
        const int step = reduction(image.width, image.height);
        const Difference e = difference(image, references[run["reference"]].image);
        run["image"] = data_uri(shown(reduced(image, step), space));
        run["difference"] = data_uri(false_color(reduced(e, step), comparison["difference_scale"]));
    }
    for (Json& each : comparison["references"]) {
        const PreciseImage& image = references[each["id"]].image;
        const int step = reduction(image.width, image.height);
        each["image"] = data_uri(shown(reduced(to_float(image), step), spaces[each["id"]]));
    }
}

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

// Copies the intact references that are missing in `into`. Damaged ones are left out: another shard
// may have them intact.
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

// Throws Error if the folder's study is another one than the list's, or drew other data.
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

// Throws Error if a journal in `into` does not agree with the beginning of the one to replace it.
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

// Locks a folder that several shards write into, so that one at a time reads the journals and
// writes results. So the results written last include all records.
class FolderLock {
  public:
    explicit FolderLock(const std::filesystem::path& folder)
        : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
        if (descriptor_ < 0) fail("{}: cannot read: {}", folder.string(), std::strerror(errno));
        // EWOULDBLOCK: another process has the lock. Any other errno means that the file system has
        // no locks, and then it does not wait.
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

nlohmann::ordered_json report_of(const StudyResults& results) {
    Json json{{"title", results.list.title},
              {"kind", "study"},
              {"findings", study_findings(results)},
              {"environment", results.environment},
              {"base", settings_json(results.list.base)},
              {"swept", results.list.swept},
              {"comparisons", Json::array()},
              {"dropped", Json::array()}};
    const Json answers = tree_answers(results);
    if (!answers.is_null()) json["answers"] = answers;
    for (std::size_t scene = 0; scene < results.list.scenes.size(); ++scene)
        json["comparisons"].push_back(comparison_of(results, scene));
    for (const RunList::Dropped& dropped : results.list.dropped)
        json["dropped"].push_back({{"because", dropped.because}, {"runs", dropped.runs}});
    return json;
}

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
    // runs.json is not replaced: `into` may be one of the folders that are read.
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
    for (Json& comparison : report["comparisons"]) add_pictures(comparison, folder);
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
