// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "study/crosscheck_report.h"

namespace lamina::study {
namespace {

constexpr const char* part_names[] = {"mesh discretisation", "the slicing method", "the PT method"};

std::string dominance_of(const ErrorBudget::Part& part) {
    if (part.key == "gradients") return "the gradients dominate";
    return fmt::format("{}{} dominates", part.key == "mesh" ? "" : "the ", part.name);
}

struct PairAt {
    std::size_t projection = 0, slicing = 0;
};

std::string tets_text(std::int64_t count) {
    return fmt::format("{} tet{}", count, count == 1 ? "" : "s");
}

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

bool same_pair(const PairAt& a, const PairAt& b) {
    return a.projection == b.projection && a.slicing == b.slicing;
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

// Returns the pair of the scene's own settings.
PairAt own_pair(const Crosscheck& crosscheck) {
    PairAt own;
    for (std::size_t p = 0; p < crosscheck.projections.size(); ++p)
        if (crosscheck.projections[p].tolerance == crosscheck.tolerance) own.projection = p;
    for (std::size_t s = 0; s < crosscheck.slicings.size(); ++s)
        if (crosscheck.slicings[s].samples == crosscheck.samples) own.slicing = s;
    return own;
}

// Returns the cheapest pair whose pictures agree, or nothing where no pair does.
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

// `told`: pairs whose difference other findings say.
std::string agreement(const Crosscheck& crosscheck, double wanted,
                      const std::vector<PairAt>& told) {
    if (const auto found = cheapest_agreeing(crosscheck, wanted)) {
        const Crosscheck::Projection& projection = crosscheck.projections[found->projection];
        return fmt::format(
            "The cheapest pair that agrees within {:g}/255 in every pixel is {}: PT takes {:.3g} "
            "ms a frame and {:.3g} s for its mesh, slicing {:.3g} ms.",
            wanted, settings_text(crosscheck, *found), projection.times.ms,
            projection.mesh_ms / 1000, crosscheck.slicings[found->slicing].times.ms);
    }
    const PairAt at = closest(crosscheck);
    const bool is_told = std::any_of(told.begin(), told.end(),
                                     [&](const PairAt& each) { return same_pair(each, at); });
    return fmt::format(
        "PT and slicing agree nowhere on this ladder within {:g}/255 in every pixel; they are "
        "closest at {}. Finer: --tolerances, --samples and mesh.max_tets; for noise, mesh.kuhn.",
        wanted, is_told ? settings_text(crosscheck, at) : pair_text(crosscheck, at));
}

}  // namespace

// Each pair of settings is told once: the coarsest and the finest may be the scene's own.
std::vector<std::string> crosscheck_findings(const Crosscheck& crosscheck,
                                             const ErrorBudget& budget,
                                             const CrosscheckSubject& subject) {
    std::string shares;
    for (const ErrorBudget::Part& part : budget.parts)
        shares += fmt::format("{}{} {}", shares.empty() ? "" : ", ", part.name, share_text(part));
    const PairAt own = own_pair(crosscheck), coarsest;
    const PairAt finest{crosscheck.projections.size() - 1, crosscheck.slicings.size() - 1};
    std::vector<PairAt> told{own};
    std::vector<std::string> findings{fmt::format(
        "{}: with {}, projected tetrahedra (PT) and slicing differ by Linf {:.3g} and L2 {:.3g} "
        "(1/255), and {}. The parts explain: {}.",
        subject.name, settings_text(crosscheck, own), budget.raw_error.all.linf,
        budget.raw_error.all.l2, dominance_of(budget.dominant()), shares)};
    for (const auto& [word, at] : {std::pair("coarsest", coarsest), {"finest", finest}}) {
        if (std::any_of(told.begin(), told.end(),
                        [&, &at = at](const PairAt& each) { return same_pair(each, at); }))
            continue;
        findings.push_back(fmt::format("At the {} settings, {}.", word, pair_text(crosscheck, at)));
        told.push_back(at);
    }
    findings.push_back(agreement(crosscheck, subject.wanted, told));
    return findings;
}

}  // namespace lamina::study
