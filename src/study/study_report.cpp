// SPDX-License-Identifier: Apache-2.0
#include "study/study_report.h"

#include <algorithm>
#include <cmath>

#include "base/arithmetic.h"
#include "image/difference_picture.h"
#include "image/exr.h"
#include "study/error_json.h"
#include "study/study_findings.h"
#include "study/thumbnail.h"
#include "study/tree_advice.h"
#include "study/tree_plots.h"

namespace lamina::study {
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
    // Of the runs that were compared with a reference.
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
