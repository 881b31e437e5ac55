// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "compositing/dither.h"
#include "facts/facts.h"
#include "facts/mesh_facts.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"
#include "plan/compositing_plan.h"
#include "plan/omission.h"
#include "plan/project_plan.h"
#include "plan/sample_trials.h"
#include "plan/tree_choice.h"

namespace lamina {

// Where the fragments of the slicing renderer get the scalar from.
enum class VolumeSampling {
    none,      // the transfer function is constant over the volume: no scalar is needed
    fetch,     // eight texel fetches and float arithmetic
    filtered,  // linear filter of a float texture, where that was measured to be exact
    hardware,  // linear filter of a texture in the file's own type, with the hardware's weights
};

// A part of the volume that one texture holds: samples first .. first + size - 1; neighbours share
// a layer of samples.
struct TextureBrick {
    std::array<std::int64_t, 3> first{0, 0, 0};
    std::array<std::int64_t, 3> size{1, 1, 1};
    // Samples reach as far as the volume's box: what lies one beyond its own repeats its border.
    bool bordered = false;

    friend bool operator==(const TextureBrick&, const TextureBrick&) = default;
};

struct SlicePlan : CompositingPlan {
    int slabs = 1;
    std::optional<SlabTrial> slab_trial;  // of "samples": "auto"
    std::string filter_reason;            // of "filter": "auto", where it takes the hardware's
    double filter_error = 0;    // of "filter": "auto" where samples are given, found, in 1/255
    std::string target_reason;  // of "target": "auto"
    std::optional<Dither> dither;
    std::optional<TreePlan> tree;
    std::optional<double> error_bound;  // of "tree": "auto", in 1/255, with its reason
    std::string tree_reason;
    Classification classification = Classification::post;
    VolumeSampling sampling = VolumeSampling::fetch;
    bool float_texture = false;    // samples normalised to their range and stored as R32F
    bool table_filtered = false;   // tables go through the texture unit's filter instead of fetches
    bool orthographic = false;     // rays are parallel: one direction, one length per depth
    bool single_color = false;     // colour is a constant of the program
    bool precise_rays = true;      // rays and chords in double precision
    bool nan_transparent = false;  // samples may be NaN
    int batches = 1;               // draws of a frame, each waited for: progress, and Ctrl-C
    bool nothing_visible = false;  // no slab is drawn
    bool linear = false;  // pre-integrated in closed form: colour and extinction are linear
    TablePlan table;      // else, for Classification::preintegrated
    IndexBox drawn;  // polygons cover this part of the box (segments are those of the whole box)
    bool occupied_only = false;     // what comes near no occupied brick is not evaluated
    bool constant_regions = false;  // marched rays take these in one step
    // Marched rays end at this optical depth: what lies behind does not show.
    double opaque_depth = std::numeric_limits<double>::infinity();
    std::vector<TextureBrick> bricks;

    // In 1/255, of slabs, filter and table as far as it was measured.
    double found_error() const {
        return slab_trial ? slab_trial->error : filter_error + table.error;
    }
    bool has_tree(NodeArithmetic nodes) const { return tree && tree->nodes == nodes; }
    bool ends_early() const { return opaque_depth < std::numeric_limits<double>::infinity(); }
    // Segments by the scalars at both ends and in the middle, not in the middle alone.
    bool integrates_runs() const {
        return classification == Classification::preintegrated && sampling != VolumeSampling::none;
    }
    bool uses_table() const { return integrates_runs() && !linear; }

    friend bool operator==(const SlicePlan&, const SlicePlan&) = default;
};

// The plan without remarks that change no picture.
SlicePlan without_remarks(SlicePlan plan);
// And with what belongs to one view as it is by default: what renderers make for all views is a
// matter of the rest.
SlicePlan of_all_views(SlicePlan plan);

// What will run: a pure function of scene, facts and capabilities, printable.
struct Plan {
    Method method = Method::slice;
    SlicePlan slice;      // for Method::slice
    ProjectPlan project;  // for Method::project
    Work work;            // of a frame, as predicted
    std::vector<Omission> omitted;
};

// Throws Error when the context cannot do what the scene asks for, naming the limit. `trials`: for
// what is automatic.
Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const SampleTrials& trials = {});
// The same of Method::slice, without what omissions save: for frames.
Plan plan_alone(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                const OmissionSwitch& omissions, const SampleTrials& trials = {});
// For methods that draw a mesh (Scene::draws_mesh).
Plan make_plan(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions);

// A table for people: what runs, then what is left out and why (--explain).
std::string explain(const Plan& plan, const Facts& facts, const Capabilities& capabilities);
std::string explain(const Plan& plan, const MeshFacts& facts, const Capabilities& capabilities);

}  // namespace lamina
