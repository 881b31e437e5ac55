// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "base/client.h"
#include "facts/mesh_facts.h"
#include "lamina/image.h"
#include "lamina/report.h"
#include "lamina/settings.h"
#include "lamina/volume.h"
#include "plan/choices.h"
#include "plan/compositing_plan.h"
#include "scene/camera.h"
#include "visibility/visibility_order.h"
#include "volume/min_max_bricks.h"

namespace lamina {

// The predicted work of a frame.
struct Work {
    double segments = 0;  // segments of rays in slabs that are evaluated
    double fetches = 0;   // fetches of the volume's texels by OpenGL's fragments
    double tets = 0;      // projected tets, or cell fragments if tets are cut
    double ordered = 0;   // tets put in visibility order
    double passes = 0;    // layers that are composited onto images one by one
    double bytes = 0;     // size of the volume, tables and images that are read and written

    // Returns the amounts that are not 0, with their names.
    std::vector<std::pair<const char*, double>> amounts() const;
};

Work operator-(const Work& a, const Work& b);

// Returns, for example, "12.3 M segments, 4.1 kB": the amounts above 0.
std::string to_text(const Work& work);

// Work that is left out because this scene does not need it.
struct Omission {
    std::string name;    // as in --no-omit=NAME
    std::string reason;  // the fact that decided
    Work saves{};        // predicted work that it saves in a frame
};

// The omissions that the user has switched off.
struct OmissionSwitch {
    bool none = false;           // --no-omit: leave out nothing
    std::set<std::string> kept;  // --no-omit=NAME
    bool allows(const std::string& name) const { return !none && !kept.contains(name); }
};
std::vector<std::string> omission_names();

// Collects the omissions of a planner, in the order of its choices.
struct Omissions {
    const OmissionSwitch& allowed;
    std::vector<Omission> list = {};

    // Returns true, and records the omission, if the scene does not need `name` and the user has
    // not switched that off.
    bool leave_out(bool unneeded, const std::string& name, const std::string& reason) {
        if (!unneeded || !allowed.allows(name)) return false;
        list.push_back({name, reason});
        return true;
    }
};

// A box of the volume's samples that one texture holds: samples first .. first + size - 1.
// Neighbouring bricks share a layer of samples.
struct TextureBrick {
    std::array<std::int64_t, 3> first{0, 0, 0};
    std::array<std::int64_t, 3> size{1, 1, 1};
    // True: at the volume's border the texture holds one more layer, which repeats the border
    // sample, so that its samples reach as far as the volume's box.
    bool bordered = false;

    friend bool operator==(const TextureBrick&, const TextureBrick&) = default;
};

// How the ray's segment between the front and the back of a tet is integrated.
enum class SegmentSource {
    constant,   // the transfer function is constant over the mesh: no scalar is needed
    table,      // one look-up in a table with equally spaced scalars
    parts,      // tets are cut at the transfer function's points. Opacity has a closed form; colour
                // is one look-up in a table that does not depend on the transfer function
                // (optics/segment_integral.h)
    cut_table,  // up to three look-ups in a table whose scalar nodes lie on the transfer function's
                // points
    analytic,   // the linear pieces of the segment, each in closed form
    mean,       // the mean of the optics at front and back: Coloring::attenuation
    vertices    // no integration: Coloring::vertex
};

// The part of a projection's plan that decides the picture. A renderer prepares for it once.
struct ProjectedPicture : CompositingPlan, LightPlan {
    SegmentSource source = SegmentSource::table;
    Interpolation interpolation = Interpolation::perspective;
    Thickness thickness = Thickness::exact;
    OrderMethod visibility = OrderMethod::exact;
    // True: rings of tets that hide one another are ordered by pixel (visibility/ring_order.h).
    bool solve_rings = false;
    ProjectGeometry geometry = ProjectGeometry::silhouette;  // never automatic
    ProjectDither dither = ProjectDither::none;
    std::uint32_t seed = 1;     // for dithering and stochastic rounding
    std::vector<int> tree;      // bifurcation factors of fixed-point nodes; empty: none
    bool scattered = false;     // the tets of a tree's leaf come from all over the mesh
    bool orthographic = false;  // rays are parallel; fragments need no division
    bool single_color = false;  // the colour is a constant of the program
    // True: depths on faces are found in float32 for tets for which that is exact enough. False: in
    // double precision for all.
    bool plain = true;
    bool draw_transparent = false;  // transparent tets are drawn, too
    bool nothing_visible = false;   // no tet is drawn
    bool table_filtered = false;    // tables are read through the texture unit's filter
    // Eye-space depth of the near plane, in the plan's units, as are lengths in tables.
    double near_depth = 0;
    ValueRange range;  // scalars, [0, 1] in shaders; lo < hi
    // True: the range is the window of visible scalars. Scalars may lie outside it; there the
    // transfer function is constant.
    bool windowed = false;
    TablePlan table;  // for SegmentSource::table (uniform) and ::cut_table (knots)

    // Tells whether the program, not the blending unit, rounds opacity to codes.
    bool in_codes() const { return emulation.has_value() || dither != ProjectDither::none; }

    friend bool operator==(const ProjectedPicture&, const ProjectedPicture&) = default;
};

// Remarks on a projection; they change no picture.
struct ProjectRemarks {
    std::string target_reason;  // for "target": "auto"
    MeshFacts::TrialError trial_error;
    ErrorFigure error;  // of the picture
};

// The plan of Method::project.
struct ProjectPlan : ProjectedPicture, ProjectRemarks {
    const ProjectedPicture& picture() const { return *this; }
};

const char* name_of(SegmentSource source);

// How the slicing renderer's fragments read the scalar.
enum class VolumeSampling {
    none,      // the transfer function is constant over the volume: no scalar is needed
    fetch,     // eight texel fetches and float arithmetic
    filtered,  // linear filter of a float texture, if the filter was measured to be exact
    hardware,  // linear filter of a texture in the file's own type, with the weights of the
               // hardware
};

// The part of a slicing plan that decides the picture in any view. Renderers prepare for it once.
struct PlannedPicture : CompositingPlan, LightPlan {
    int slabs = 1;
    std::optional<Dither> dither;
    std::optional<TreePlan> tree;
    Classification classification = Classification::post;
    VolumeSampling sampling = VolumeSampling::fetch;
    bool float_texture = false;  // samples normalised to their range and stored as R32F
    // Tables are read through the texture unit's filter, not by single fetches.
    bool table_filtered = false;
    bool single_color = false;     // the colour is a constant of the program
    bool precise_rays = true;      // rays and chords in double precision
    bool nan_transparent = false;  // samples may be NaN
    int batches = 1;  // number of draws of a frame, each waited for, for progress and Ctrl-C
    // True: segments are integrated in closed form: colour and extinction are linear in the scalar.
    bool linear = false;
    TablePlan table;  // for Classification::preintegrated, unless `linear`
    // Segments end at these planes, in the volume's index space.
    std::vector<IndexPlane> clip;
    bool constant_regions = false;  // marched rays cross constant regions in one step
    std::vector<TextureBrick> bricks;
    // The box of the volume, in its index space, that this renderer draws if several draw one
    // picture together (volume_shares.h); none: not shared. Exact segments end at the box's faces.
    // Other slabs' segments are drawn, uncut, by the renderer whose box holds their middle.
    std::optional<IndexBox> share;
    // Error, in 1/255, of exact segments that follow curves instead of straight pieces between
    // smooth points of the transfer function; 0 if there are no curves.
    double curve_error = 0;

    bool has_tree(NodeArithmetic nodes) const { return tree && tree->nodes == nodes; }
    // Tells whether segments are integrated from their ends and middle, not from the middle alone.
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
    // Rays are parallel: all have one direction and one length per depth.
    bool orthographic = false;
    bool nothing_visible = false;  // no slab is drawn
    // The box that polygons cover, inside the volume's, to which segments are clipped.
    IndexBox drawn;
    bool occupied_only = false;  // segments that come near no occupied brick are not evaluated
    // Optical depth at which marched rays end, because nothing behind it is visible.
    double opaque_depth = std::numeric_limits<double>::infinity();

    bool ends_early() const { return opaque_depth < std::numeric_limits<double>::infinity(); }

    friend bool operator==(const ViewPart&, const ViewPart&) = default;
};

// Remarks on a slicing plan: reasons, and errors found, in 1/255. They change no picture.
struct Remarks {
    std::optional<SlabTrial> slab_trial;  // the trial that was chosen, for "samples": "auto"
    std::string filter_reason;  // for "filter": "auto", if the texture unit's filter is chosen
    // Error found of the texture unit's filter: for "filter": "auto" with a given number of slabs.
    double filter_error = 0;
    std::string classification_reason;  // for "classification": "auto"
    std::string target_reason;          // for "target": "auto"
    std::optional<double> error_bound;  // for "tree": "auto"; tree_reason explains it
    std::string tree_reason;
    // Bound on the error that compositing adds, with a chosen or given tree; none if unknown.
    std::optional<double> rounding_bound;
    // Largest error of exact segments, in 1/255. It grows in proportion to the brightest colour
    // above 1, because a picture is linear in its colours.
    double segment_error = exact_segment_error;

    friend bool operator==(const Remarks&, const Remarks&) = default;
};

// The plan of Method::slice.
struct SlicePlan : PlannedPicture, ViewPart, Remarks {
    // Returns the measured error of slabs, filter and table, in 1/255; or that of exact segments.
    double found_error() const {
        if (integrates_cells()) return segment_error + light_error + curve_error;
        return slab_trial ? slab_trial->error : filter_error + table.error;
    }
    // Returns the error including the bound on roundings. It is unknown if the scene gives the
    // number of slabs, because nothing was measured.
    ErrorFigure error() const;

    friend bool operator==(const SlicePlan&, const SlicePlan&) = default;
};

// Returns the part of a plan that renderers prepare for, without what a view changes in its table,
// and without the table's error. Two plans for which it is equal differ only in the view.
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

// Makes the plan. Throws Error, naming the limit, if the context cannot do what the scene asks for.
// `trials`: measured errors, for automatic choices. `tables`: a cache with earlier plans' tables.
Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const SampleTrials& trials = {},
               const std::shared_ptr<TableCache>& tables = std::make_shared<TableCache>());
// Makes a slicing plan without the work that omissions save: quicker, for frames of moving scenes.
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

// Draws frames of one scene as its plan says: by slicing or projection, with OpenGL or by the cpu
// engine. Its constructor prepares the data and tables that all frames share.
class FrameRenderer {
  public:
    virtual ~FrameRenderer() = default;

    // Takes another plan of the same scene and size for further frames. Returns false, and changes
    // nothing, if that plan needs other preparations: if it differs in more than the view.
    virtual bool take(const Plan& plan) = 0;
    // Draws a frame, which is complete on return. Ctrl-C ends it between steps; `progress` advances
    // by step_count() in all.
    virtual void draw(const View& view, Progress* progress = nullptr) = 0;
    virtual int step_count() const = 0;
    // Returns the last frame: associated, linear, before the background. Reuses `image` if it fits.
    virtual void read(Image& image) const = 0;
    Image read() const {
        Image image;
        read(image);
        return image;
    }

    // Returns durations of the preparations and the last frame's stages, by their printed names.
    virtual std::map<std::string, double> stages_ms() const = 0;
    // Returns the number of fragments of the last frame; 0 with OpenGL, where queries count them.
    virtual std::int64_t fragments() const { return 0; }
    // Returns the host memory taken beside the data; 0 with OpenGL, which has its own memory.
    virtual std::int64_t byte_count() const { return 0; }
};

}  // namespace lamina
