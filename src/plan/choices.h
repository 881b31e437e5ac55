// SPDX-License-Identifier: Apache-2.0
// The choices that scenes leave to planners: light, slabs, target, classification, table, tree.
#pragma once

#include <optional>
#include <string>

#include "compositing/codes.h"
#include "compositing/tree_shape.h"
#include "facts/volume_facts.h"
#include "lamina/scene.h"
#include "lamina/settings.h"
#include "plan/capabilities.h"
#include "preintegration/preintegration_table.h"

namespace lamina {

// Lighting of a scene as it is drawn.
struct LightPlan {
    std::optional<Lighting> lighting;  // with the smallest gradient that is lit
    // Largest bend of light in a piece of a ray; pieces with more are cut. The bend is the second
    // difference of light at the piece's three nodes (docs/numerics.md, sections 10.4 and 10.5).
    double most_bend = 0;
    double light_error = 0;  // error that pieces with less bend may make, in 1/255

    friend bool operator==(const LightPlan&, const LightPlan&) = default;
};

// Plans the light of a scene. `max_color`: the largest colour component of the unlit picture.
// `cuts_rays`: the method cuts rays at bends of light.
LightPlan plan_light(const Scene& scene, double max_color, bool cuts_rays);

// Returns the largest number of loop iterations that an OpenGL fragment takes, beyond those of
// unlit scenes, to cut its ray at bends of light.
double light_iterations(const Scene& scene, double max_color);

// Returns the largest colour component that may be drawn with light. `max_color`: without light.
double largest_drawn_color(const Scene& scene, double max_color);

// These throw Error for a lit scene that the method cannot draw with its light.
void check_lit_slicing(const Scene& scene);
void check_lit_projection(const Scene& scene);

// The error of slicing into `slabs` slabs, found on rays all over the picture.
struct SlabTrial {
    int slabs = 1;
    double error = 0;         // Linf of colour and opacity, in 1/255
    std::int64_t rays = 0;    // number of rays that were tried
    double goal = 0;          // largest error that is allowed: slab_error_goal(), in 1/255
    std::int64_t traced = 0;  // rays that were compared with the reference tracer
    // True: the picture's error may be larger than `error`. Only some rays were traced, and erred
    // by more than comparing with more slabs had shown, or `error` is implausibly small.
    bool doubtful = false;
    bool keeps_goal() const { return error <= goal; }

    friend bool operator==(const SlabTrial&, const SlabTrial&) = default;
};

// Trials of several numbers of slabs, for automatic choices (slicing/slab_trials.h makes them).
struct SampleTrials {
    // Trials for "samples": "auto"; otherwise empty.
    std::vector<SlabTrial> exact;
    // Trials for "filter": "auto", with filter weights rounded to 8 bits as in texture units;
    // otherwise empty. If the scene gives the slabs, errors are those of the weights alone.
    std::vector<SlabTrial> hardware;
};

// Returns the number of slabs, 1 .. max_slabs, that makes `slabs` slabs per voxel along the view.
int slabs_per_voxel(const Facts& facts, double slabs);

// Returns the goal of the trials of an automatic number of slabs: the largest error, in 1/255, that
// they may find. Automatic compositing takes its share of max_error first. The goal is stricter if
// only `rays` of the picture's rays are tried, because the largest error of all rays is then larger
// than the one found. `max_color` and `slabs` matter if the target is automatic, too.
double slab_error_goal(const Scene& scene, double max_color, int slabs, double rays);

// Tells whether the errors fall with about the second power of the number of slabs, as for smooth
// pictures. Otherwise fewer slabs may by chance have a smaller error than more.
bool are_of_second_order(std::vector<SlabTrial> trials);

// Makes the choice of "samples": "auto". It is the fewest slabs whose trial keeps its goal. If none
// does, it is the fewest slabs, of two a voxel or more, whose error is near the least. If nothing
// was tried, it is two slabs a voxel, with an unknown error (NaN).
SlabTrial chosen_slabs(const Facts& facts, const SampleTrials& trials);

// Makes the choice of "filter": "auto": the fewest slabs whose trial with the weights of texture
// units keeps its goal, if any does.
std::optional<SlabTrial> slabs_of_hardware_filter(const SampleTrials& trials);

// Share of max_error by which an automatic target may round. It is so small that slabs, which get
// the rest of max_error, need hardly be more (their error falls with the square of their number).
inline constexpr double target_share = 0.15;

// A target and why it is taken.
struct TargetChoice {
    Target target = Target::float32;
    std::string reason;  // empty if the scene names the target
    double error = 0;    // bound on its rounding, in 1/255; 0 if no bound is known or needed
};

// Makes the choice of "target": "auto" for slicing: the target with the fewest bytes a pixel whose
// compositing error is within target_share of max_error.
TargetChoice choose_target(const Scene& scene, const Facts& facts, const SampleTrials& trials);
TargetChoice choose_target(const Scene& scene, double max_color, int slabs);
TargetChoice choose_project_target(const Scene& scene);

// Gives the scene a target. If a target smaller than float32 was chosen for slicing without a tree,
// the scene also gets a tree, because the bound of the choice is the bound of a tree.
Scene with_chosen_target(Scene scene, Target target);

// Largest error of exact segments in float32, in 1/255, of colours up to 1, unless roundings of the
// scalar may change more (SliceRemarks::surface_error; docs/precision.md, "Exact segments").
inline constexpr double exact_segment_error = 0.05;

// A classification and why it is taken.
struct ClassificationChoice {
    Classification classification = Classification::post;  // not automatic
    int slabs = 1;       // for exact segments if the scene names none
    std::string reason;  // empty if the scene names the classification
};

// Makes the choice of "classification": "auto" for slicing: exact segments, unless the context's
// loops are too short for them or `trials` found few enough quicker slabs (slicing/slab_trials.h).
// Throws Error if the filter or the number of slabs cannot do what the scene asks for.
ClassificationChoice choose_classification(const Scene& scene, const Facts& facts,
                                           const Capabilities& capabilities,
                                           const SampleTrials& trials = {});

// Largest number of post-classified slabs a voxel that take less time than exact segments: these
// take, as measured, as long as 2.7 slabs a voxel or more (docs/precision.md).
inline constexpr double quicker_slabs_per_voxel = 2;

// Tells whether trials may find slabs that are quicker than the exact segments which "auto" would
// choose. Never for targets whose error grows with the number of slabs.
bool may_be_quicker(const Scene& scene);

// Gives the scene the chosen classification and, for exact segments, a number of slabs: the scene's
// own, that of its tree, or the choice's. With exact segments all numbers are equally good.
Scene with_classification(Scene scene, const ClassificationChoice& choice);

// The next four functions respect a limit of llvmpipe: it silently ends the loops of a fragment, or
// of a pixel's invocation of a compute shader, after 65535 iterations in all
// (LP_MAX_TGSI_LOOP_ITERATIONS).

// Returns the largest number of slabs that one invocation can march through. With exact segments,
// slabs are those of a ray that is cut into `slabs`, which must be at least least_exact_slabs().
int most_marched_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                       int slabs);

// Returns the largest number of slabs that one invocation can composite on codes, one by one. Exact
// segments that several slabs need take their iterations for each.
int most_coded_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                     int slabs);

// Returns the number of slabs into which a ray must be cut so that one fragment can walk through
// the cells of each.
int least_exact_slabs(const Scene& scene, const Facts& facts, const Capabilities& capabilities);

// Returns the least render.max_error that one fragment can keep with light, for which it cuts its
// ray; 0 if the context has no such limit.
double least_lit_error(const Scene& scene, const Facts& facts, const Capabilities& capabilities);

// Share of max_error that a table may add to the picture's error.
inline constexpr double table_share = 0.1;

// Largest optical depth of a segment for which a table of a single layer, the limit of short
// segments, is enough. The front half of a segment of depth D weighs 1/2 + D/12 + O(D^3), so a
// ray's colour is off by less than D / 12 of its change within a segment, at most .5 / 255.
inline constexpr double short_depth = 0.02;

// Sets table.built to the table that its request asks for, from the cache or newly built.
void get_table(const Scene& scene, const Facts& facts, TablePlan& table, TableCache& tables);

// Returns the largest error of colour, in 1/255, that the built table makes on Facts::scalar_rays
// cut into `slabs` segments, and on single segments in linear pieces. Opacity is exact.
double table_error(const Scene& scene, const Facts& facts, int slabs, const TablePlan& table);

// Chooses the scalar nodes and lengths of a coloured table whose range and max_length are set: of a
// few sizes, the coarsest with an error of at most table_share of max_error or, if there is none,
// the one with the smallest error.
// `depth`: a segment's largest optical depth; 0 if the limit of short segments is enough.
void refine_table(const Scene& scene, const Facts& facts, int slabs, double depth, TablePlan& table,
                  TableCache& tables);

// Takes the table that the scene asks for, over the range that is already set. If the longest
// segment of this view, of `longest` world units, exceeds the longest one of that table, the table
// is extended for all views of such a camera, with layers as close as the scene asks for. The table
// is built, and its error measured, if there are Facts::scalar_rays.
void take_table(const Scene& scene, const Facts& facts, int slabs, double longest, double unit,
                TablePlan& table, TableCache& tables);

// A compositing tree over the slabs of a picture.
struct TreePlan {
    std::vector<int> factors;  // children of a node, for each level from the root to the leaves
    NodeArithmetic nodes = NodeArithmetic::shader;
    NodeCode code = NodeCode::minimax;
    int alpha_bits = 8;
    double largest_color = 1;  // the colour component that images of shader nodes store as 1

    friend bool operator==(const TreePlan&, const TreePlan&) = default;
};

// The facts on which the choice of "tree": "auto" depends.
struct TreeQuestion {
    Target target = Target::float32;
    Emulation emulation;
    int slabs = 1;
    int visible_slabs = 1;  // largest number of slabs that are composited on one ray and show
    Order order = Order::back_to_front;
    std::optional<Dither> dither;  // if opacity is rounded to codes with dithering
    double largest_color = 1;      // largest colour component that is composited
    double max_error = 1;          // in 1/255, as the scene has it
    double slab_error = 0;  // the share of max_error that the slabs were found to use, in 1/255
};

// A tree or none, and why.
struct TreeChoice {
    std::optional<TreePlan> tree;  // none: slabs are blended one after the other
    // Bound on the error of compositing, in 1/255, relative to an exact compositing of these slabs;
    // none for a tree that was given.
    std::optional<double> error_bound;
    std::string reason;
};

// These return bounds on the error of compositing, in 1/255 (docs/precision.md derives them): if
// slabs are blended, and if one node composites them in float.
double straight_error_bound(const TreeQuestion& question);
double one_level_error_bound(const TreeQuestion& question);

// Returns a bound on the error of a plan's compositing, in 1/255: by blending if there is no tree,
// or by shader nodes. None for a tree with several levels whose code has no such bound (only
// minimax has one), and for fixed-point nodes.
std::optional<double> rounding_bound(const TreeQuestion& question,
                                     const std::optional<TreePlan>& tree);

// Chooses between blending and a tree: the cheaper one whose error bound fits into the share of
// max_error that the slabs leave, or, if neither fits, the one with the smaller bound. Throws Error
// if compositing alone exceeds max_error and the scene asks for another target than float32.
TreeChoice choose_tree(const TreeQuestion& question);

// Throws Error if the scene's own tree cannot be drawn. `single_color`: all visible has one colour.
void check_slice_tree(const Scene& scene, bool single_color);
void check_project_tree(const Scene& scene, bool single_color);

}  // namespace lamina
