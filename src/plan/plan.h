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

// Counts of the work that a plan predicts for a frame.
struct Work {
    double segments = 0;  // rays' segments in slabs that are evaluated
    double fetches = 0;   // texels of the volume that OpenGL's fragments fetch
    double tets = 0;      // tets that are projected, or cell fragments if tets are cut
    double ordered = 0;   // tets that are sorted into visibility order
    double passes = 0;    // layers that are composited onto an image, one after the other
    double bytes = 0;     // bytes of the volume, tables and images that are read and written

    // Returns the counts that are not 0, with their names.
    std::vector<std::pair<const char*, double>> amounts() const;
};

Work operator-(const Work& a, const Work& b);

// Returns the counts above 0 as text, for example "12.3 M segments, 4.1 kB".
std::string to_text(const Work& work);

// A kind of work that the plan leaves out, because it would not change the picture of this scene.
struct Omission {
    std::string name;    // as in --no-omit=NAME
    std::string reason;  // the fact of the scene that allows it
    Work saves{};        // predicted work that it saves in each frame
};

// Says which omissions the user allows: all, unless switched off.
struct OmissionSwitch {
    bool none = false;           // --no-omit: no omission is allowed
    std::set<std::string> kept;  // --no-omit=NAME: names of omissions that are not allowed
    bool allows(const std::string& name) const { return !none && !kept.contains(name); }
};
std::vector<std::string> omission_names();

// Collects the omissions of a plan while it is made.
struct Omissions {
    const OmissionSwitch& allowed;
    std::vector<Omission> list = {};

    // Decides whether the work `name` is left out: if the scene does not need it (`unneeded`) and
    // the user allows the omission. If so, adds the omission to the list.
    bool leave_out(bool unneeded, const std::string& name, const std::string& reason) {
        if (!unneeded || !allowed.allows(name)) return false;
        list.push_back({name, reason});
        return true;
    }
};

// A box of the volume's samples that is drawn from one texture. Neighbouring bricks share a layer
// of samples, so that every cell lies in one brick.
struct TextureBrick {
    std::array<std::int64_t, 3> first{0, 0, 0};  // x, y, z of the first sample
    std::array<std::int64_t, 3> size{1, 1, 1};   // number of samples along x, y, z
    // True: at the volume's border the texture has one more layer, a copy of the border samples. It
    // covers the half voxel between the border samples and the faces of the volume's box.
    bool bordered = false;

    friend bool operator==(const TextureBrick&, const TextureBrick&) = default;
};

// How the colour and opacity of a ray's segment in a tet are found.
enum class SegmentSource {
    constant,   // from constants: the transfer function is constant over the mesh
    table,      // one look-up in a pre-integration table whose scalar nodes are equally spaced
    parts,      // tets are cut into cell fragments at the transfer function's points. Opacity has a
                // closed form; colour takes one look-up in a table that is the same for every
                // transfer function (optics/segment_integral.h)
    cut_table,  // up to three look-ups in a pre-integration table whose scalar nodes lie on the
                // transfer function's points
    analytic,   // the segment is cut into its linear pieces; each has a closed form
    mean,       // from the mean of the optics at both ends: Coloring::attenuation
    vertices    // from the colours of the vertices, without integration: Coloring::vertex
};

// All of a projection's plan that affects the picture. A renderer prepares for it once.
struct ProjectedPicture : CompositingPlan, LightPlan {
    SegmentSource source = SegmentSource::table;
    Interpolation interpolation = Interpolation::perspective;
    Thickness thickness = Thickness::exact;
    OrderMethod visibility = OrderMethod::exact;
    // True: rings of tets that hide one another are sorted by pixel (visibility/ring_order.h), also
    // those with tets that overlap.
    bool solve_rings = false;
    // The pairs of tets that overlap, to be ordered by entry (mesh/tet_overlaps.h); may be null.
    std::shared_ptr<const std::vector<TetPair>> overlaps;
    ProjectGeometry geometry = ProjectGeometry::silhouette;  // never automatic
    ProjectDither dither = ProjectDither::none;
    std::uint32_t seed = 1;  // of the random numbers of dithering and stochastic rounding
    std::vector<int> tree;   // bifurcation factors of a tree of fixed-point nodes; empty: no tree
    bool scattered = false;  // each leaf of the tree gets tets from all over the mesh
    bool orthographic = false;  // rays are parallel, so that fragments need no division
    bool single_color = false;  // all that is visible has one colour, a constant of the program
    // True: depths on faces are computed in float32 for the tets for which it is exact enough, and
    // in double precision for the others. False: in double precision for all tets.
    bool plain = true;
    bool draw_transparent = false;  // tets that are invisible are drawn nevertheless
    bool nothing_visible = false;   // no tet is drawn
    bool table_filtered = false;    // tables are read through the texture unit's linear filter
    bool walk = false;              // rays walk from tet to tet (projection/gl_mesh_walk.h)
    bool blocks = false;            // tables are storage blocks, not textures
    double near_depth = 0;          // eye-space depth of the near plane, in the plan's units
    ValueRange range;               // scalars that are normalised to [0, 1]; lo < hi
    // True: `range` is the window, the scalars between which something visible changes. A mesh may
    // have scalars outside it, for which the transfer function is constant.
    bool windowed = false;
    TablePlan table;  // for SegmentSource::table (uniform) and ::cut_table (knots)

    // Tells whether the program rounds opacity to codes, and not the blending unit.
    bool in_codes() const { return emulation.has_value() || dither != ProjectDither::none; }

    friend bool operator==(const ProjectedPicture&, const ProjectedPicture&) = default;
};

// Remarks on a projection for reports. They do not affect the picture.
struct ProjectRemarks {
    std::string target_reason;          // why this target was chosen, for "target": "auto"
    MeshFacts::TrialError trial_error;  // of `source`, on some rays of the view
    ErrorFigure error;                  // of the picture
    // The error of all rays but those along surfaces (facts/surface_rays.h), if that of these is
    // more than max_error leaves and the picture's is unknown for this reason.
    ErrorFigure error_of_others;
};

// The plan for Method::project.
struct ProjectPlan : ProjectedPicture, ProjectRemarks {
    const ProjectedPicture& picture() const { return *this; }
};

const char* name_of(SegmentSource source);

// How slicing reads the scalar at a point of the volume.
enum class VolumeSampling {
    none,      // not at all: the transfer function is constant over the volume
    fetch,     // eight texels, interpolated by the program in float32
    filtered,  // the linear filter of a float texture, if it was measured to be exact
    hardware,  // the linear filter of a texture of the file's type, with its rounded weights
};

// All of a slicing plan that affects the picture, except what each view decides (ViewPlan). A
// renderer prepares for it once.
struct SlicedPicture : CompositingPlan, LightPlan {
    int slabs = 1;
    std::optional<Dither> dither;
    std::optional<TreePlan> tree;
    Classification classification = Classification::post;
    VolumeSampling sampling = VolumeSampling::fetch;
    bool float_texture = false;   // the texture has normalised samples in R32F, not the file's type
    bool words = false;           // samples are words of a storage buffer, not texels
    bool table_filtered = false;  // tables are read through the texture unit's linear filter
    bool single_color = false;    // all that is visible has one colour, a constant of the program
    bool precise_rays = true;     // rays and chords are computed in double precision
    bool nan_transparent = false;  // samples may be NaN, which is transparent
    bool nearest = false;          // VolumeLookup::nearest: cells are voxels
    RayDispatch rays;              // of compute shaders
    // Largest number of slabs that one dispatch marches, because drivers end long loops.
    int marched_slabs = std::numeric_limits<int>::max();
    // Draw calls for a frame. Each is waited for, so that progress is shown and Ctrl-C works.
    int batches = 1;
    // True: colour and extinction are linear in the scalar, so that segments have a closed form.
    bool linear = false;
    TablePlan table;                // for Classification::preintegrated, unless `linear`
    std::vector<IndexPlane> clip;   // planes, in index space, at which segments end
    bool constant_regions = false;  // marched rays cross regions of constant scalar in one step
    std::vector<TextureBrick> bricks;
    // The box, in index space, that this renderer draws if several renderers share a picture
    // (volume_shares.h); none if it draws all. Exact segments end at the box's faces. The segment
    // of a slab is not cut: the renderer whose box contains its middle draws it.
    std::optional<IndexBox> share;
    // Error, in 1/255, of exact segments that replace straight pieces of the transfer function by
    // curves through its smooth points; 0 if they do not.
    double curve_error = 0;

    bool has_tree(NodeArithmetic nodes) const { return tree && tree->nodes == nodes; }
    // Tells whether segments are integrated from the scalars at both ends and in the middle. Else
    // the middle alone decides.
    bool preintegrates() const {
        return classification == Classification::preintegrated && sampling != VolumeSampling::none;
    }
    bool integrates_cells() const {
        return classification == Classification::exact && sampling != VolumeSampling::none;
    }
    bool uses_table() const { return preintegrates() && !linear; }

    friend bool operator==(const SlicedPicture&, const SlicedPicture&) = default;
};

// The choices of a slicing plan that depend on the view. They are made again for each camera.
struct ViewPlan {
    bool orthographic = false;     // rays are parallel
    bool nothing_visible = false;  // no slab is drawn
    IndexBox drawn;                // box inside the volume's to which slabs and rays are clipped
    bool occupied_only = false;    // segments far from every visible min/max brick are skipped
    // Optical depth at which marched rays end, because what is behind is invisible; else infinity.
    double opaque_depth = std::numeric_limits<double>::infinity();

    bool ends_early() const { return opaque_depth < std::numeric_limits<double>::infinity(); }

    friend bool operator==(const ViewPlan&, const ViewPlan&) = default;
};

// Remarks on a slicing plan for reports: reasons for automatic choices, and errors in 1/255. They
// do not affect the picture.
struct SliceRemarks {
    std::optional<SlabTrial> slab_trial;  // trial of the chosen number, for "samples": "auto"
    std::string filter_reason;  // for "filter": "auto", if the texture unit's filter is chosen
    double filter_error = 0;    // measured, for "filter": "auto" with a given number of slabs
    // Bound on what the context's arithmetic may change of the trial picture, which the cpu engine
    // draws; 0 on the cpu engine.
    double context_error = 0;
    std::string classification_reason;  // for "classification": "auto"
    std::string target_reason;          // for "target": "auto"
    std::optional<double> error_bound;  // of compositing, for "tree": "auto"
    std::string tree_reason;            // for "tree": "auto"; explains error_bound
    // Bound on the error that compositing adds, whether the tree is chosen or given; none: unknown.
    std::optional<double> rounding_bound;
    // Largest error of exact segments. A picture is linear in its colours, so the error grows in
    // proportion to the brightest colour above 1.
    double segment_error = exact_segment_error;
    // Bound on what roundings of the scalar may change of a ray of exact segments that runs along a
    // surface at which the transfer function jumps. 0: less than segment_error, which counts it.
    // Infinite: more than max_error leaves, so that no error is stated.
    double surface_error = 0;
    // Bound on what they may change of a ray along any surface, in ramps, too, if that is more than
    // max_error leaves; else 0. The picture's error does not count it, but has it beside
    // (ErrorFigure::along_ramps; docs/precision.md, "Jumps").
    double ramp_error = 0;

    friend bool operator==(const SliceRemarks&, const SliceRemarks&) = default;
};

// The plan for Method::slice.
struct SlicePlan : SlicedPicture, ViewPlan, SliceRemarks {
    // Returns the error without that of compositing, in 1/255: of exact segments, or the measured
    // one of slabs, filter and table.
    double found_error() const {
        if (integrates_cells()) return segment_error + light_error + curve_error;
        return slab_trial ? slab_trial->error : filter_error + table.error;
    }
    // Returns the picture's error: found_error() plus rounding_bound and surface_error, or, if it
    // was found by trials, context_error. It is unknown if the scene gives the number of slabs,
    // because then nothing is measured.
    ErrorFigure error() const;

    friend bool operator==(const SlicePlan&, const SlicePlan&) = default;
};

// Returns the picture without the two things that a view may change in it: the largest length in
// its table, and the table's error. Two plans with equal results differ only in the view.
SlicedPicture of_all_views(SlicedPicture picture);

// Says how a picture is drawn and what is left out, and holds the pre-integration tables that are
// looked up. It is a pure function of scene, facts, trials and capabilities; explain() prints it.
struct Plan {
    Method method = Method::slice;
    SlicePlan slice;      // for Method::slice
    ProjectPlan project;  // for Method::project
    Work work;            // of a frame
    std::vector<Omission> omitted;

    // Returns the picture's error; unknown for Method::trace, which estimates its own.
    ErrorFigure error() const;
};

// Makes the plan of a scene that draws a volume. Throws Error, naming the limit, if the context
// cannot do what the scene asks for. `trials`: measured errors, on which automatic choices depend.
// `tables`: a cache in which tables of earlier plans are found again.
Plan make_plan(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions, const SampleTrials& trials = {},
               const std::shared_ptr<TableCache>& tables = std::make_shared<TableCache>());
// Makes a slicing plan as make_plan() does, but leaves Omission::saves 0. This is quicker, for
// frames while the user moves the camera.
Plan plan_alone(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                const OmissionSwitch& omissions, const SampleTrials& trials,
                const std::shared_ptr<TableCache>& tables);
// Makes the plan of a method that draws a mesh (Scene::draws_mesh).
Plan make_plan(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
               const OmissionSwitch& omissions,
               const std::shared_ptr<TableCache>& tables = std::make_shared<TableCache>());

// Returns the plan as a table for people (--explain): how the picture is drawn, then what is left
// out and why.
std::string explain(const Plan& plan, const Facts& facts, const Capabilities& capabilities);
std::string explain(const Plan& plan, const MeshFacts& facts, const Capabilities& capabilities);

// Draws frames of one scene as its plan says: by slicing or projection, with OpenGL or with the cpu
// engine. The constructors of derived classes prepare data and tables, which all frames share.
class FrameRenderer {
  public:
    virtual ~FrameRenderer() = default;

    // Uses another plan of the same scene and size for further frames. Returns false, and changes
    // nothing, if that plan differs in more than the view and so needs other preparations.
    virtual bool try_switch_to(const Plan& plan) = 0;
    // Draws a frame, which is complete on return. It has step_count() steps; `progress` advances by
    // one with each, and Ctrl-C ends the frame between two of them.
    virtual void draw(const View& view, Progress* progress = nullptr) = 0;
    virtual int step_count() const = 0;
    // Copies the last frame, in associated linear colours and without the background, to `image`,
    // whose memory is used again if it has the right size.
    virtual void read(Image& image) const = 0;
    Image read() const {
        Image image;
        read(image);
        return image;
    }

    // Returns the durations of the preparations and of the last frame's stages by printed name.
    virtual std::map<std::string, double> stages_ms() const = 0;
    // Returns the number of fragments of the last frame; 0 with OpenGL, where a query counts them.
    virtual std::int64_t fragments() const { return 0; }
    // Returns the bytes of main memory taken in addition to the data; 0 with OpenGL.
    virtual std::int64_t byte_count() const { return 0; }
};

}  // namespace lamina
