// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/difference.h"
#include "lamina/image.h"
#include "plan/capabilities.h"
#include "study/data_store.h"
#include "study/study_frames.h"

namespace lamina::study {

// One volume drawn by two methods, and for each method the exact picture of the data that it draws.
struct FourPictures {
    Image traced_volume, traced_mesh, sliced, projected;
    ImageColorSpace space = ImageColorSpace::linear;  // of all of them
    // Pictures of a lit scene traced without its lighting; empty if the scene is not lit.
    Image unlit_volume{}, unlit_mesh{};
};

// Splits the difference of the two methods into parts, in every pixel:
//   projected - sliced = (traced mesh - traced volume) - (sliced - traced volume)
//                        + (projected - traced mesh)
// If the scene is lit, the first part is that of the unlit pictures, and what lighting adds to it
// is a fourth part, "gradients": those of a mesh differ from those of the volume it is made from.
struct ErrorBudget {
    struct Part {
        std::string key, name;  // in files, in sentences
        Difference e;           // in 1/255
        ImageError error;
        // Share of the raw difference d that the part s explains: <s, d> / <d, d>, with the sign
        // that the part has in the sum above. The shares add up to 1. It is 0 if d is 0.
        double share = 0;
    };

    // Mesh discretisation, slicing method, projection method; if the scene is lit, gradients, too.
    std::vector<Part> parts;
    Difference raw;  // projected - sliced
    ImageError raw_error;
    double residual = 0;  // largest |raw - sum of the parts|, in 1/255; this is rounding

    const Part& dominant() const;  // the part with the largest L2
};

// Throws Error if the pictures differ in size.
ErrorBudget error_budget(const FourPictures& pictures);

struct CrosscheckSettings {
    // Tolerances of the meshes that are made from the volume, in addition to the scene's own.
    std::vector<double> tolerances{0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001};
    // If true, refining ends once both methods agree within the scene's max_error, or a mesh would
    // have more than `ladder_tets` tets. A mesh that the scene states is drawn in any case.
    bool ends_by_itself = true;
    std::int64_t ladder_tets = 250000;  // takes about a minute on one processor
    // Numbers of slabs, in addition to the scene's own.
    std::vector<int> samples{64, 128, 256, 512, 1024};
    int rounds = 3;  // rounds of interleaved frames, >= 3
    // Folder in which meshes and traced pictures are kept, and in which earlier ones are looked
    // for.
    std::filesystem::path kept;
    // Called once the volume is read, before anything is kept.
    std::function<void()> begin = [] {};
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

// One volume drawn by both methods, each from coarse to fine sampling.
struct Crosscheck {
    struct Slicing {
        int samples = 0;
        Image picture;
        ImageError error;  // error against the traced volume
        FrameTimes times;
        std::int64_t bytes = 0;
    };
    struct Projection {
        double tolerance = 0;  // 0 for a mesh from a file
        // Certified error, as a share of the range of values; 0 if it is not known.
        double mesh_error = 0;
        bool stopped = false;  // refining stopped because of too many tets
        std::int64_t tets = 0;
        double mesh_ms = 0;  // time to make or read the mesh
        Image traced, picture;
        ImageError mesh_part, method_part, error;  // `error` is against the traced volume
        FrameTimes times;
        std::int64_t bytes = 0;
    };
    struct Pair {
        ErrorNorms raw;            // projected - sliced
        std::size_t dominant = 0;  // part with the largest L2: 0 mesh, 1 slicing, 2 projection
    };

    FourPictures pictures;  // at the scene's own settings
    int samples = 0;        // slabs of `pictures.sliced`
    double tolerance = 0;
    double reference_error = 0;  // error estimate of the traced volume, in 1/255
    double reference_ms = 0;
    std::vector<Slicing> slicings;         // by increasing number of slabs
    std::vector<Projection> projections;   // by decreasing tolerance
    std::vector<std::vector<Pair>> pairs;  // [projection][slicing]
};

// Tells whether meshes of several tolerances can be made from the scene's volume: not if its mesh
// is a file, nor if it is a Kuhn mesh, which has no tolerance.
bool makes_meshes(const Scene& scene);

// Draws and traces all pictures. The scene must have a volume. If it states no mesh, the pictures
// shown are of the mesh of tolerance .02, or of the finest one if refining ends before. Throws
// Error.
Crosscheck crosscheck(const Scene& scene, const CrosscheckSettings& settings,
                      const Capabilities& capabilities);

// Returns "1 slab", "64 slabs".
std::string slabs_text(int count);

// Returns the part's share of the difference: "99.9 %".
std::string share_text(const ErrorBudget::Part& part);

// Facts that a report states beside the results of a cross-check.
struct CrosscheckSubject {
    std::string name;                    // name of the scene
    double wanted = 1;                   // largest error that counts as agreement, Linf in 1/255
    nlohmann::ordered_json environment;  // machine and version, for the report
};

// Returns the contents of budget.json: the error budget of the four pictures, and all results of
// both methods.
nlohmann::ordered_json budget_json(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                   const CrosscheckSubject& subject);

// Returns the document that the page shows (docs/study.md).
nlohmann::ordered_json crosscheck_report(const Crosscheck& crosscheck, const ErrorBudget& budget,
                                         const CrosscheckSubject& subject);

// Returns the findings as sentences, for stdout and the page.
std::vector<std::string> crosscheck_findings(const Crosscheck& crosscheck,
                                             const ErrorBudget& budget,
                                             const CrosscheckSubject& subject);

}  // namespace lamina::study
