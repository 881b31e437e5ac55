// SPDX-License-Identifier: Apache-2.0
#include "study/crosscheck.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "image/difference.h"
#include "study/report_files.h"
#include "study/study_results.h"

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

// Keys of the parts, numbered as in Pair::dominant. Gradients are counted with the mesh.
constexpr const char* part_keys[] = {"mesh", "slicing", "projection"};

Json error_json(const ImageError& error) {
    Json json = to_json(error.all);
    json["channels"] = to_json(error)["channels"];
    return json;
}

Json times_json(const FrameTimes& times) {
    return {{"median", times.ms}, {"min", times.min}, {"max", times.max}, {"n", times.count}};
}

// Describes the picture of either method at one setting, compared with the traced volume.
Json run_json(std::string name, Json keys, const ImageError& error, const FrameTimes& times,
              std::int64_t bytes, const Crosscheck& crosscheck) {
    Json json{{"id", name},
              {"name", std::move(name)},
              {"keys", std::move(keys)},
              {"reference", "volume"},
              {"frame_ms", times_json(times)},
              {"ratio", times.ms / crosscheck.slicings.front().times.ms}};
    json.update(error_json(error));
    json["bytes"] = bytes;
    json["near_reference"] = error.all.linf < 10 * crosscheck.reference_error;
    return json;
}

std::string slicing_name(int samples) {
    return "slicing, " + slabs_text(samples);
}

std::string tets_text(std::int64_t count) {
    return fmt::format("{} tet{}", count, count == 1 ? "" : "s");
}

std::string projection_name(const Crosscheck::Projection& each) {
    return each.tolerance > 0 ? fmt::format("PT, tolerance {:g}", each.tolerance)
                              : "PT, " + tets_text(each.tets);
}

Json runs_json(const Crosscheck& crosscheck, double scale) {
    Json runs = Json::array();
    const auto add = [&](Json run, const Image& picture) {
        const int step = reduction(picture.width, picture.height);
        run["image"] = data_uri(shown(reduced(picture, step), crosscheck.pictures.space));
        run["difference"] = data_uri(false_color(
            reduced(difference(picture, crosscheck.pictures.traced_volume), step), scale));
        runs.push_back(std::move(run));
    };
    for (const Crosscheck::Slicing& each : crosscheck.slicings) {
        add(run_json(slicing_name(each.samples),
                     {{"method", "slicing"}, {"render.slice.samples", each.samples}}, each.error,
                     each.times, each.bytes, crosscheck),
            each.picture);
    }
    for (const Crosscheck::Projection& each : crosscheck.projections) {
        add(run_json(projection_name(each),
                     {{"method", "projected tetrahedra (PT)"},
                      {"mesh.tolerance", each.tolerance},
                      {"tets", each.tets}},
                     each.error, each.times, each.bytes, crosscheck),
            each.picture);
    }
    std::vector<CostAndError> points;
    for (const Json& run : runs) points.push_back({run["frame_ms"]["median"], run["l2"]});
    const std::vector<bool> front = pareto_front(points);
    for (std::size_t i = 0; i < front.size(); ++i) runs[i]["pareto"] = bool(front[i]);
    return runs;
}

Json plot(const char* title, const char* x, const char* y) {
    return {{"title", title},
            {"x", {{"label", x}, {"log", true}}},
            {"y", {{"label", y}, {"log", true}}},
            {"series", Json::array()}};
}

Json plots_json(const Crosscheck& crosscheck) {
    Json meshes = plot("Parts of the error of projected tetrahedra (PT) over the mesh", "tets",
                       "L2 error (1/255)"),
         slabs = plot("Slicing's error over its slabs", "slabs", "L2 error (1/255)"),
         pairs = plot("Projected tetrahedra (PT) - slicing over the mesh", "tets", "Linf (1/255)");
    Json discretisation = Json::array(), method = Json::array(), slicing = Json::array();
    for (const Crosscheck::Projection& each : crosscheck.projections) {
        discretisation.push_back({each.tets, each.mesh_part.all.l2, projection_name(each)});
        method.push_back({each.tets, each.method_part.all.l2, projection_name(each)});
    }
    for (std::size_t s = 0; s < crosscheck.slicings.size(); ++s) {
        const Crosscheck::Slicing& each = crosscheck.slicings[s];
        slicing.push_back({each.samples, each.error.all.l2, slicing_name(each.samples)});
        Json against = Json::array();
        for (std::size_t p = 0; p < crosscheck.projections.size(); ++p) {
            against.push_back({crosscheck.projections[p].tets, crosscheck.pairs[p][s].raw.linf,
                               projection_name(crosscheck.projections[p])});
        }
        pairs["series"].push_back({{"name", slabs_text(each.samples)}, {"points", against}});
    }
    meshes["series"] = {{{"name", "mesh discretisation"}, {"points", discretisation}},
                        {{"name", "PT method"}, {"points", method}}};
    slabs["series"] = Json::array({{{"name", "slicing method"}, {"points", slicing}}});
    return Json::array({meshes, slabs, pairs});
}

Json pictures_json(const Crosscheck& crosscheck, const ErrorBudget& budget, double scale) {
    Json pictures = Json::array();
    const int step =
        reduction(crosscheck.pictures.sliced.width, crosscheck.pictures.sliced.height, 512);
    const auto add = [&](const std::string& title, const std::string& caption,
                         const CodedImage& picture) {
        pictures.push_back({{"title", title}, {"caption", caption}, {"image", data_uri(picture)}});
    };
    // Adds a difference with its colour bar; `largest` tells how far it exceeds the bar.
    const auto add_difference = [&](const std::string& title, const std::string& caption,
                                    const Difference& e, double largest) {
        add(title, caption, false_color(reduced(e, step), scale));
        pictures.back()["scale"] = scale;
        pictures.back()["largest"] = largest;
    };
    const FourPictures& four = crosscheck.pictures;
    for (const auto& [title, image] : {std::pair("traced volume", &four.traced_volume),
                                       {"traced mesh", &four.traced_mesh},
                                       {"sliced volume", &four.sliced},
                                       {"projected mesh", &four.projected}})
        add(title, "", shown(reduced(*image, step), four.space));
    for (const ErrorBudget::Part& part : budget.parts) {
        add_difference(part.name, share_text(part) + " of PT - slicing", part.e,
                       part.error.all.linf);
    }
    add_difference("PT - slicing", "", budget.raw, budget.raw_error.all.linf);
    return pictures;
}

Json ladder_json(const Crosscheck& crosscheck) {
    Json ladder{
        {"slicing", Json::array()}, {"projection", Json::array()}, {"pairs", Json::array()}};
    for (const Crosscheck::Slicing& each : crosscheck.slicings) {
        ladder["slicing"].push_back({{"samples", each.samples},
                                     {"frame_ms", times_json(each.times)},
                                     {"method", error_json(each.error)}});
    }
    for (const Crosscheck::Projection& each : crosscheck.projections) {
        ladder["projection"].push_back({{"tolerance", each.tolerance},
                                        {"mesh_error", each.mesh_error},
                                        {"tets", each.tets},
                                        {"mesh_ms", each.mesh_ms},
                                        {"frame_ms", times_json(each.times)},
                                        {"mesh", error_json(each.mesh_part)},
                                        {"method", error_json(each.method_part)},
                                        {"all", error_json(each.error)}});
    }
    for (std::size_t p = 0; p < crosscheck.projections.size(); ++p) {
        for (std::size_t s = 0; s < crosscheck.slicings.size(); ++s) {
            Json pair{{"tolerance", crosscheck.projections[p].tolerance},
                      {"samples", crosscheck.slicings[s].samples},
                      {"dominant", part_keys[crosscheck.pairs[p][s].dominant]}};
            pair.update(to_json(crosscheck.pairs[p][s].raw));
            ladder["pairs"].push_back(pair);
        }
    }
    return ladder;
}

constexpr const char* part_names[] = {"mesh discretisation", "the slicing method", "the PT method"};

std::string dominance_of(const ErrorBudget::Part& part) {
    if (part.key == "gradients") return "the gradients dominate";
    return fmt::format("{}{} dominates", part.key == "mesh" ? "" : "the ", part.name);
}

struct PairAt {
    std::size_t projection = 0, slicing = 0;

    friend bool operator==(const PairAt&, const PairAt&) = default;
};

std::string mesh_text(const Crosscheck::Projection& projection) {
    if (projection.tolerance == 0)
        return fmt::format("the mesh file ({})", tets_text(projection.tets));
    return fmt::format("tolerance {:g} ({}{})", projection.tolerance, tets_text(projection.tets),
                       projection.stopped ? fmt::format(", as many as it may have: {:.2g} reached",
                                                        projection.mesh_error)
                                          : "");
}

const Crosscheck::Pair& pair_at(const Crosscheck& crosscheck, const PairAt& at) {
    return crosscheck.pairs[at.projection][at.slicing];
}

std::string settings_text(const Crosscheck& crosscheck, const PairAt& at) {
    return fmt::format("{} and {}", mesh_text(crosscheck.projections[at.projection]),
                       slabs_text(crosscheck.slicings[at.slicing].samples));
}

std::string pair_text(const Crosscheck& crosscheck, const PairAt& at) {
    const Crosscheck::Pair& pair = pair_at(crosscheck, at);
    return fmt::format("{}: Linf {:.3g}, and {} dominates", settings_text(crosscheck, at),
                       pair.raw.linf, part_names[pair.dominant]);
}

// Returns the indices of the pair at the scene's own settings.
PairAt own_pair(const Crosscheck& crosscheck) {
    PairAt own;
    for (std::size_t p = 0; p < crosscheck.projections.size(); ++p)
        if (crosscheck.projections[p].tolerance == crosscheck.tolerance) own.projection = p;
    for (std::size_t s = 0; s < crosscheck.slicings.size(); ++s)
        if (crosscheck.slicings[s].samples == crosscheck.samples) own.slicing = s;
    return own;
}

// Returns the agreeing pair with the least sum of frame times, or nothing if no pair agrees.
std::optional<PairAt> cheapest_agreeing(const Crosscheck& crosscheck, double wanted) {
    std::optional<PairAt> best;
    double least = 0;
    for (std::size_t p = 0; p < crosscheck.projections.size(); ++p) {
        for (std::size_t s = 0; s < crosscheck.slicings.size(); ++s) {
            const double ms = crosscheck.projections[p].times.ms + crosscheck.slicings[s].times.ms;
            if (crosscheck.pairs[p][s].raw.linf > wanted || (best && ms >= least)) continue;
            best = PairAt{p, s};
            least = ms;
        }
    }
    return best;
}

PairAt closest(const Crosscheck& crosscheck) {
    PairAt best;
    for (std::size_t p = 0; p < crosscheck.projections.size(); ++p) {
        for (std::size_t s = 0; s < crosscheck.slicings.size(); ++s) {
            if (crosscheck.pairs[p][s].raw.linf < pair_at(crosscheck, best).raw.linf) best = {p, s};
        }
    }
    return best;
}

// Says at which settings the pictures agree. `mentioned`: pairs that other findings mention
// already.
std::string agreement(const Crosscheck& crosscheck, double wanted,
                      const std::vector<PairAt>& mentioned) {
    if (const auto found = cheapest_agreeing(crosscheck, wanted)) {
        const Crosscheck::Projection& projection = crosscheck.projections[found->projection];
        return fmt::format(
            "The cheapest pair that agrees within {:g}/255 in every pixel is {}: PT takes {:.3g} "
            "ms a frame and {:.3g} s for its mesh, slicing {:.3g} ms.",
            wanted, settings_text(crosscheck, *found), projection.times.ms,
            projection.mesh_ms / 1000, crosscheck.slicings[found->slicing].times.ms);
    }
    const PairAt at = closest(crosscheck);
    const bool is_mentioned = std::ranges::find(mentioned, at) != mentioned.end();
    return fmt::format(
        "PT and slicing agree nowhere on this ladder within {:g}/255 in every pixel; they are "
        "closest at {}. Finer: --tolerances, --samples and mesh.max_tets; for noise, mesh.kuhn.",
        wanted, is_mentioned ? settings_text(crosscheck, at) : pair_text(crosscheck, at));
}

}  // namespace

std::string slabs_text(int count) {
    return fmt::format("{} slab{}", count, count == 1 ? "" : "s");
}

std::string share_text(const ErrorBudget::Part& part) {
    const double percent = std::round(1000 * part.share) / 10;
    return fmt::format("{:.1f} %", percent == 0 ? 0 : percent);  // no "-0.0"
}

nlohmann::ordered_json budget_json(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                   const CrosscheckSubject& subject) {
    Json parts;
    for (const ErrorBudget::Part& part : budget.parts) {
        parts[part.key] = error_json(part.error);
        parts[part.key]["share"] = part.share;
    }
    return {{"scene", subject.name},
            {"samples", crosscheck.samples},
            {"tolerance", crosscheck.tolerance},
            {"reference_error", crosscheck.reference_error},
            {"wanted", subject.wanted},
            {"parts", parts},
            {"raw", error_json(budget.raw_error)},
            {"residual", budget.residual},
            {"dominant", budget.dominant().key},
            {"findings", crosscheck_findings(crosscheck, budget, subject)},
            {"environment", subject.environment},
            {"ladder", ladder_json(crosscheck)}};
}

nlohmann::ordered_json crosscheck_report(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                         const CrosscheckSubject& subject) {
    const double scale = std::max(budget.raw_error.all.linf / 2, 1e-6);
    const Image& traced = crosscheck.pictures.traced_volume;
    const int step = reduction(traced.width, traced.height);
    const Json reference{
        {"id", "volume"},
        {"of", "volume"},
        {"error_estimate", crosscheck.reference_error},
        {"ms", crosscheck.reference_ms},
        {"width", traced.width},
        {"height", traced.height},
        {"image", data_uri(shown(reduced(traced, step), crosscheck.pictures.space))}};
    Json comparison{{"scene", subject.name},
                    {"baseline", slicing_name(crosscheck.slicings.front().samples)},
                    {"difference_scale", scale},
                    {"references", Json::array({reference})},
                    {"runs", runs_json(crosscheck, scale)},
                    {"plots", plots_json(crosscheck)},
                    {"pictures", pictures_json(crosscheck, budget, scale)}};
    return {{"title", fmt::format("Projected tetrahedra (PT) against slicing: {}", subject.name)},
            {"kind", "crosscheck"},
            {"findings", crosscheck_findings(crosscheck, budget, subject)},
            {"environment", subject.environment},
            {"swept", {"method", "render.slice.samples", "mesh.tolerance", "tets"}},
            {"comparisons", Json::array({comparison})},
            {"dropped", Json::array()}};
}

// Mentions each pair of settings once, also if the coarsest or the finest is the scene's own.
std::vector<std::string> crosscheck_findings(const Crosscheck& crosscheck,
                                             const ErrorBudget& budget,
                                             const CrosscheckSubject& subject) {
    std::string shares;
    for (const ErrorBudget::Part& part : budget.parts)
        shares += fmt::format("{}{} {}", shares.empty() ? "" : ", ", part.name, share_text(part));
    const PairAt own = own_pair(crosscheck), coarsest;
    const PairAt finest{crosscheck.projections.size() - 1, crosscheck.slicings.size() - 1};
    std::vector<PairAt> mentioned{own};
    std::vector<std::string> findings{fmt::format(
        "{}: with {}, projected tetrahedra (PT) and slicing differ by Linf {:.3g} and L2 {:.3g} "
        "(1/255), and {}. The parts explain: {}.",
        subject.name, settings_text(crosscheck, own), budget.raw_error.all.linf,
        budget.raw_error.all.l2, dominance_of(budget.dominant()), shares)};
    for (const auto& [word, at] : {std::pair("coarsest", coarsest), {"finest", finest}}) {
        if (std::ranges::find(mentioned, at) != mentioned.end()) continue;
        findings.push_back(fmt::format("At the {} settings, {}.", word, pair_text(crosscheck, at)));
        mentioned.push_back(at);
    }
    findings.push_back(agreement(crosscheck, subject.wanted, mentioned));
    return findings;
}

}  // namespace lamina::study
