// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compositing/codes.h"
#include "facts/mesh_facts.h"
#include "facts/volume_facts.h"
#include "lamina/error_figure.h"
#include "lamina/scene.h"
#include "plan/brick_cuts.h"
#include "plan/capabilities.h"
#include "plan/classification_choice.h"
#include "plan/compositing_plan.h"
#include "plan/light_choice.h"
#include "plan/omission.h"
#include "plan/project_plan.h"
#include "plan/slab_choice.h"
#include "plan/tree_choice.h"
#include "preintegration/table_cache.h"

namespace lamina {

// Ways in which the slicing renderer's fragments read the scalar.
enum class VolumeSampling {
    none,      // the transfer function is constant over the volume: no scalar is needed
    fetch,     // eight texel fetches and float arithmetic
    filtered,  // linear filter of a float texture, if the filter was measured to be exact
    hardware,  // linear filter of a texture in the file's own type, with the weights of the
               // hardware
};

// The picture that slicing draws, independent of the view. Renderers prepare for it once.
struct PlannedPicture : CompositingPlan, LightPlan {
    int slabs = 1;
    std::optional<Dither> dither;
    std::optional<TreePlan> tree;
    Classification classification = Classification::post;
    VolumeSampling sampling = VolumeSampling::fetch;
    bool float_texture = false;  // samples normalised to their range and stored as R32F
    // tables are read through the texture unit's filter, not by single fetches
    bool table_filtered = false;
    bool single_color = false;     // the colour is a constant of the program
    bool precise_rays = true;      // rays and chords in double precision
    bool nan_transparent = false;  // samples may be NaN
    int batches = 1;  // number of draws of a frame, each waited for, for progress and Ctrl-C
    // Segments are integrated in closed form, because colour and extinction are linear in the
    // scalar.
    bool linear = false;
    TablePlan table;  // otherwise, for Classification::preintegrated
    // Segments end at these planes, in the volume's index space.
    std::vector<IndexPlane> clip;
    bool constant_regions = false;  // marched rays cross constant regions in one step
    std::vector<TextureBrick> bricks;
    // The box of the volume, in its index space, that this renderer draws of a picture that several
    // draw together (volume_shares.h); none: all of it. Exact segments end at its faces. A slab's
    // segment is drawn whole by the renderer whose box has its middle.
    std::optional<IndexBox> share;
    // Error, in 1/255, of exact segments that follow curves between smooth points of the transfer
    // function; 0: they follow straight pieces.
    double curve_error = 0;

    bool has_tree(NodeArithmetic nodes) const { return tree && tree->nodes == nodes; }
    // Tells whether segments are integrated from the scalars at both ends and in the middle.
    // Otherwise they take the scalar in the middle alone.
    bool integrates_runs() const {
        return classification == Classification::preintegrated && sampling != VolumeSampling::none;
    }
    // Tells whether rays are integrated cell by cell.
    bool integrates_cells() const {
        return classification == Classification::exact && sampling != VolumeSampling::none;
    }
    bool uses_table() const { return integrates_runs() && !linear; }

    friend bool operator==(const PlannedPicture&, const PlannedPicture&) = default;
};

// The part of a plan that depends on the view, and is planned again with each camera.
struct ViewPart {
    // rays are parallel: all have one direction and one length per depth
    bool orthographic = false;
    bool nothing_visible = false;  // no slab is drawn
    // Polygons cover only this box inside the volume's box. Segments are clipped to the volume's
    // box.
    IndexBox drawn;
    bool occupied_only = false;  // segments that come near no occupied brick are not evaluated
    // Optical depth at which marched rays end, because nothing behind it is visible.
    double opaque_depth = std::numeric_limits<double>::infinity();

    bool ends_early() const { return opaque_depth < std::numeric_limits<double>::infinity(); }

    friend bool operator==(const ViewPart&, const ViewPart&) = default;
};

// Remarks say why slices are drawn in this way, and which errors were found, in 1/255. They change
// no picture.
struct Remarks {
    std::optional<SlabTrial> slab_trial;  // the trial that was chosen, for "samples": "auto"
    std::string filter_reason;  // for "filter": "auto", if the hardware's filter is chosen
    // Error that the hardware's filter was found to add: for "filter": "auto" with a given number
    // of slabs.
    double filter_error = 0;
    std::string classification_reason;  // for "classification": "auto"
    std::string target_reason;          // for "target": "auto"
    std::optional<double> error_bound;  // for "tree": "auto"; tree_reason explains it
    std::string tree_reason;
    // Bound on the error that compositing adds to that of the slabs, chosen or given; none if
    // nothing is known.
    std::optional<double> rounding_bound;
    // Largest error of exact segments. A picture is linear in its colours, and so is the error at a
    // crossing of the transfer function: it grows with the brightest colour above 1.
    double segment_error = exact_segment_error;

    friend bool operator==(const Remarks&, const Remarks&) = default;
};

struct SlicePlan : PlannedPicture, ViewPart, Remarks {
    // Returns the measured error of slabs, filter and table, in 1/255; or that of exact segments.
    double found_error() const {
        if (integrates_cells()) return segment_error + light_error + curve_error;
        return slab_trial ? slab_trial->error : filter_error + table.error;
    }
    // Returns the error including the bound on roundings; unknown for slabs that the scene states,
    // because nothing was measured.
    ErrorFigure error() const;

    friend bool operator==(const SlicePlan&, const SlicePlan&) = default;
};

// Returns the part of a plan that renderers prepare for: another plan with an equal part draws only
// another view. Tables stay without what a view changes, and without their errors.
PlannedPicture of_all_views(PlannedPicture picture);

// Says what will run, and has the pre-integration tables that renderers look up. It is a pure
// function of scene, facts, trials and capabilities, and can be printed.
struct Plan {
    Method method = Method::slice;
    SlicePlan slice;      // for Method::slice
    ProjectPlan project;  // for Method::project
    Work work;            // predicted work of a frame
    std::vector<Omission> omitted;

    // Returns the picture's error; unknown for Method::trace, which estimates its own.
    ErrorFigure error() const;
};

// Makes the plan. Throws Error if the context cannot do what the scene asks for, and names the
// limit. `trials`: measured errors, for automatic choices. `tables`: finds the tables of earlier
// plans; without it, all are built.
Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const SampleTrials& trials = {},
               const std::shared_ptr<TableCache>& tables = std::make_shared<TableCache>());
// Makes the plan for Method::slice without the work that omissions save; quicker, for the frames of
// a moving scene.
Plan plan_alone(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                const OmissionSwitch& omissions, const SampleTrials& trials,
                const std::shared_ptr<TableCache>& tables);
// Makes the plan of a method that draws a mesh (Scene::draws_mesh).
Plan make_plan(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions,
               const std::shared_ptr<TableCache>& tables = std::make_shared<TableCache>());

// Returns a table for people: what runs, then what is left out and why (--explain).
std::string explain(const Plan& plan, const Facts& facts, const Capabilities& capabilities);
std::string explain(const Plan& plan, const MeshFacts& facts, const Capabilities& capabilities);

}  // namespace lamina
