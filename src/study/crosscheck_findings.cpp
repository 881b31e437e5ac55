// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>

#include "study/crosscheck_report.h"

namespace lamina::study {
namespace {

constexpr const char* part_names[] = {"mesh discretisation", "the slicing method", "the PT method"};

struct PairAt {
    std::size_t projection = 0, slicing = 0;
};

std::string mesh_text(const Crosscheck::Projection& projection) {
    if (projection.tolerance == 0) return fmt::format("the file's {} tets", projection.tets);
    return fmt::format(
        "tolerance {:g} ({} tets{})", projection.tolerance, projection.tets,
        projection.stopped
            ? fmt::format(", all that mesh.max_tets allows: {:.2g} reached", projection.mesh_error)
            : "");
}

const Crosscheck::Pair& pair_at(const Crosscheck& crosscheck, const PairAt& at) {
    return crosscheck.pairs[at.projection][at.slicing];
}

std::string pair_text(const Crosscheck& crosscheck, const PairAt& at) {
    const Crosscheck::Pair& pair = pair_at(crosscheck, at);
    const Crosscheck::Projection& projection = crosscheck.projections[at.projection];
    const Crosscheck::Slicing& slicing = crosscheck.slicings[at.slicing];
    return fmt::format(
        "{} and {} slabs: PT - slicing has Linf {:.3g} and L2 {:.3g}, and {} dominates (L2 of mesh "
        "discretisation {:.3g}, slicing method {:.3g}, PT method {:.3g})",
        mesh_text(projection), slicing.samples, pair.raw.linf, pair.raw.l2,
        part_names[pair.dominant], projection.mesh_part.all.l2, slicing.error.all.l2,
        projection.method_part.all.l2);
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

std::string agreement(const Crosscheck& crosscheck, double wanted) {
    if (const auto found = cheapest_agreeing(crosscheck, wanted)) {
        const Crosscheck::Projection& projection = crosscheck.projections[found->projection];
        const Crosscheck::Slicing& slicing = crosscheck.slicings[found->slicing];
        return fmt::format(
            "The cheapest pair that agrees within {:g}/255 in every pixel is {} and {} slabs (Linf "
            "{:.3g}): PT takes {:.3g} ms a frame and {:.3g} s for its mesh, slicing {:.3g} ms.",
            wanted, mesh_text(projection), slicing.samples, pair_at(crosscheck, *found).raw.linf,
            projection.times.ms, projection.mesh_ms / 1000, slicing.times.ms);
    }
    const PairAt at = closest(crosscheck);
    return fmt::format(
        "PT and slicing agree nowhere on this ladder within {:g}/255 in every pixel; they are "
        "closest at {}. Finer: --tolerances, --samples and mesh.max_tets; for noise, mesh.kuhn.",
        wanted, pair_text(crosscheck, at));
}

}  // namespace

std::vector<std::string> crosscheck_findings(const Crosscheck& crosscheck,
                                             const ErrorBudget& budget,
                                             const CrosscheckSubject& subject) {
    std::string shares;
    for (const ErrorBudget::Part& part : budget.parts) {
        shares += fmt::format("{}{} {:.1f} % (L2 {:.3g}, Linf {:.3g})", shares.empty() ? "" : ", ",
                              part.name, 100 * part.share, part.error.all.l2, part.error.all.linf);
    }
    const std::string own_mesh = crosscheck.tolerance > 0
                                     ? fmt::format("tolerance {:g}", crosscheck.tolerance)
                                     : std::string("the mesh file");
    const PairAt finest{crosscheck.projections.size() - 1, crosscheck.slicings.size() - 1};
    return {fmt::format("{}: with {} slabs and {}, PT - slicing has Linf {:.3g} and L2 {:.3g} "
                        "(1/255), of which the parts explain: {}.",
                        subject.name, crosscheck.samples, own_mesh, budget.raw_error.all.linf,
                        budget.raw_error.all.l2, shares),
            fmt::format("At the coarsest settings, {}.", pair_text(crosscheck, {0, 0})),
            fmt::format("At the finest settings, {}.", pair_text(crosscheck, finest)),
            agreement(crosscheck, subject.wanted)};
}

}  // namespace lamina::study
