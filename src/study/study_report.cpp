// SPDX-License-Identifier: Apache-2.0
#include "study/study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/arithmetic.h"
#include "image/difference_picture.h"
#include "image/exr.h"
#include "study/report_figures.h"
#include "study/result_files.h"
#include "study/tree_advice.h"

namespace lamina::study {
namespace {

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

// The runs of one scene that did not fail.
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

}  // namespace

std::vector<std::string> study_findings(const StudyResults& results) {
    const RunList& list = results.list;
    std::vector<std::string> findings;
    // The trees to take are the answer, so they come first; how all runs compare comes after them.
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

namespace {

using Json = nlohmann::ordered_json;

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

// Returns the scale of all differences of a scene: the median of the runs' L-infinity errors, so
// that half of the pictures are shown without clipping, and the others where they are worst.
double difference_scale(const std::vector<const RunResult*>& runs) {
    std::vector<double> largest;
    for (const RunResult* const run : runs) {
        if (run->failed.empty() && run->all.linf > 0) largest.push_back(run->all.linf);
    }
    return largest.empty() ? 1 : median(largest);
}

Json comparison_of(const StudyResults& results, std::size_t scene) {
    std::vector<const RunResult*> runs;
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

// Adds the pictures of one comparison.
void add_pictures_to(Json& comparison, const StudyFolder& folder) {
    std::map<std::string, Reference> references;
    for (Json& each : comparison["references"]) {
        Reference reference = ReferenceStore::load(folder.references(), each["id"]);
        each["of"] = name_of(reference.of);
        each["ms"] = reference.ms;
        each["width"] = reference.image.width;
        each["height"] = reference.image.height;
        references[each["id"]] = std::move(reference);
    }
    // Colour spaces by reference, for the runs that were compared with one.
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

void add_pictures(const StudyFolder& folder, nlohmann::ordered_json& report) {
    for (Json& comparison : report["comparisons"]) add_pictures_to(comparison, folder);
}

}  // namespace lamina::study
