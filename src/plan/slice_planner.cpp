// SPDX-License-Identifier: Apache-2.0
#include "plan/slice_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "compositing/tree_shape.h"
#include "facts/drawn_range.h"
#include "facts/ray_shares.h"
#include "facts/world_unit.h"
#include "optics/front_weights.h"
#include "plan/brick_cuts.h"
#include "plan/curve_choice.h"
#include "plan/light_choice.h"
#include "plan/march_limit.h"
#include "plan/picture_limits.h"
#include "plan/slab_choice.h"
#include "plan/table_choice.h"
#include "plan/target_choice.h"
#include "plan/tree_check.h"

namespace lamina {
namespace {

// A software frame may take a minute: it is drawn in so many parts, at no cost that could be
// measured.
constexpr int software_batches = 64;

// Rays in float32 lose the digits of this ratio of a box's sides. In software, doubles cost some 12
// % of a frame.
constexpr double thin_box_ratio = 20;

// Of a ray, where leaping over empty bricks pays. In OpenGL (llvmpipe, post-classified) hydrogen,
// of which .6 % are empty, took 1.2 times as long with it, and neghip, 30 %, .9 times.
constexpr double least_empty_in_tiles = 0.01, least_empty_in_shaders = 0.2;

constexpr std::uint64_t max_filtered_bytes = std::uint64_t{1} << 30;  // float copies of small types

class SlicePlanner {
  public:
    SlicePlanner(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                 const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables)
        : scene_(scene),
          facts_(facts),
          trials_(trials),
          tables_(tables),
          capabilities_(capabilities),
          omissions_(omissions) {}

    Plan make() {
        check_limits(scene_, capabilities_);
        SlicePlan& slice = plan_.slice;
        slice.unit = world_unit(box_diagonal(facts_.grid));
        slice.target = *scene_.target;
        slice.classification = *scene_.slice.classification;
        slice.order = scene_.slice.order;
        slice.batches = capabilities_.software ? software_batches : 1;
        slice.nan_transparent = facts_.non_finite > 0;
        slice.table_filtered =
            scene_.slice.filter == Filter::hardware || capabilities_.exact_float_filter;
        choose_clip();
        plan_light(scene_, facts_.max_color, slice);
        choose_slabs();
        choose_filter();
        choose_precision();
        choose_sampling();
        const CurveChoice curves = choose_curves(scene_, facts_, slice, capabilities_);
        if (leave_out(curves.pay, "smooth_points", curves.reason)) slice.curve_error = curves.error;
        slice.segment_error = exact_segment_error * std::max(max_color(), 1.0);
        choose_table();
        choose_bricks();
        choose_compositing();
        choose_geometry();
        choose_constant_regions();
        slice.rounding_bound =
            slice.error_bound ? slice.error_bound : rounding_bound(tree_question(), slice.tree);
        choose_termination();
        return std::move(plan_);
    }

  private:
    // True, and said, where the scene does not need `name`.
    bool leave_out(bool unneeded, const std::string& name, const std::string& reason) {
        if (!unneeded || !omissions_.allows(name)) return false;
        plan_.omitted.push_back({name, reason});
        return true;
    }

    void choose_clip() {
        const std::vector<IndexPlane> cutting = cutting_planes(facts_.clip, facts_.grid);
        const std::size_t all = facts_.clip.size(), idle = all - cutting.size();
        const std::string reason =
            fmt::format("{} of {} planes of the clip cut nothing away", idle, all);
        plan_.slice.clip = leave_out(idle > 0, "clip_planes", reason) ? cutting : facts_.clip;
    }
    double max_color() const { return largest_drawn_color(scene_, facts_.max_color); }

    void choose_slabs() {
        SlicePlan& slice = plan_.slice;
        if (scene_.slice.samples.is_given()) {
            slice.slabs = *scene_.slice.samples;
            return;
        }
        const SlabTrial chosen = chosen_slabs(facts_, trials_);
        slice.slabs = chosen.slabs;
        if (!trials_.exact.empty()) slice.slab_trial = chosen;
    }

    // Where the texture unit was measured to be no worse than what was tried. (Of tables nothing
    // was tried: they keep their fetches.)
    void choose_filter() {
        SlicePlan& slice = plan_.slice;
        if (scene_.slice.filter == Filter::hardware) slice.sampling = VolumeSampling::hardware;
        const std::optional<SlabTrial> trial = slabs_of_hardware_filter(trials_);
        if (scene_.slice.filter.is_given() || !trial || !capabilities_.eight_bit_filter) return;
        slice.filter_reason = fmt::format(
            "one look-up instead of eight: an error of {:.2g} / 255, {}, was found, of "
            "{:.3g} wanted",
            trial->error, scene_.slice.samples.is_given() ? "its own" : "with that of the slabs",
            trial->goal);
        slice.sampling = VolumeSampling::hardware;
        if (scene_.slice.samples.is_given()) {
            slice.filter_error = trial->error;
        } else {
            slice.slabs = trial->slabs;
            slice.slab_trial = trial;
        }
    }

    void choose_precision() {
        plan_.slice.precise_rays = !leave_out(
            !capabilities_.software && facts_.side_ratio < thin_box_ratio, "double_precision",
            "a GPU is slow with doubles and the box is not thin: rays are float32, chords good to "
            "1e-5");
    }

    void choose_geometry() {
        SlicePlan& slice = plan_.slice;
        slice.orthographic =
            leave_out(facts_.orthographic, "perspective",
                      "parallel rays: one direction and one length per depth for all fragments");
        const IndexBox whole{facts_.grid.index_min(), facts_.grid.index_max()};
        slice.drawn = whole;
        slice.nothing_visible = leave_out(
            facts_.occupied.empty() || facts_.far_depth <= facts_.near_depth, "drawing",
            facts_.clipped_away       ? "the clip cuts all away that the transfer function shows"
            : facts_.occupied.empty() ? "the transfer function shows no value that the volume has"
                                      : "the volume lies behind the eye");
        if (slice.nothing_visible) return;
        const bool smaller = facts_.occupied.min != whole.min || facts_.occupied.max != whole.max;
        const bool by_brick = skips_bricks();
        if (leave_out((smaller || by_brick) && !facts_.occupied.empty(), "empty_space",
                      fmt::format("only {} of the bricks of {}^3 cells can be seen: {}",
                                  percent_text(facts_.occupied_share), MinMaxBricks::edge,
                                  by_brick ? fmt::format("rays leap over the others, by a map of "
                                                         "{} bytes",
                                                         facts_.occupied_bricks.distance.size())
                                           : "slabs are drawn in the box around them"))) {
            slice.drawn = facts_.occupied;
            slice.occupied_only = by_brick;
        }
    }

    // Where enough is empty. Between two bricks that show nothing scalars may jump over what can be
    // seen where NaN parts them: a segment from one into the other would show it.
    bool skips_bricks() const {
        const SlicePlan& slice = plan_.slice;
        const bool jumps =
            facts_.non_finite > 0 && slice.classification == Classification::preintegrated;
        const std::int64_t longest = std::ranges::max(facts_.occupied_bricks.count);
        const bool leaps = capabilities_.tiles || (slice.has_tree(NodeArithmetic::shader) &&
                                                   longest <= capabilities_.max_3d_texture_size &&
                                                   facts_.occupied_bricks.distance.size() <=
                                                       capabilities_.max_texture_bytes);
        const RayShares& shares = facts_.ray_shares;
        const double least = capabilities_.tiles ? least_empty_in_tiles : least_empty_in_shaders;
        const bool pays = shares.occupied <= (1 - least) * shares.box;
        return leaps && pays && facts_.occupied_share < 1 && !jumps;
    }

    // Codes are those of slabs one by one. In OpenGL, measured in software, asking where the
    // regions are takes longer than they do.
    void choose_constant_regions() {
        SlicePlan& slice = plan_.slice;
        if (slice.nothing_visible || slice.sampling == VolumeSampling::none) return;
        const bool marches = slice.integrates_cells() || slice.has_tree(NodeArithmetic::shader);
        if (!capabilities_.tiles || !marches) return;
        const ConstantBricks& constant = facts_.constant_bricks;
        slice.constant_regions = leave_out(
            !constant.kinds.empty() && !scene_.lighting, "constant_regions",
            fmt::format("{} of the bricks that show something have one colour and one extinction: "
                        "rays take them in one step, by maps of {} bytes",
                        percent_text(constant.share), 2 * constant.kind.size()));
    }

    // In a tree, what is behind one leaf's part of a ray is another leaf's; on GL, of several
    // bricks, another program's.
    void choose_termination() {
        SlicePlan& slice = plan_.slice;
        if (slice.nothing_visible || !slice.has_tree(NodeArithmetic::shader)) return;
        if (slice.tree->factors.front() < slice.slabs) return;
        if (!capabilities_.tiles && slice.bricks.size() > 1) return;
        const double hidden = hidden_share * scene_.max_error;  // in 1/255
        if (slice.error_bound && *slice.error_bound + hidden > scene_.max_error) return;
        const double depth = opaque_depth(scene_.max_error, max_color());
        const DepthRange& seen = facts_.occupied_depth;
        const double deepest =
            facts_.max_extinction * (seen.far - seen.near) * facts_.max_length_per_depth;
        const RayShares& shares = facts_.ray_shares;
        if (leave_out(
                deepest > depth && shares.box_before_opaque < shares.box, "early_termination",
                fmt::format("rays may get {:.3g} deep and end at an optical depth of {:.3g}: "
                            "what lies behind changes no channel by more than {:.2g} / "
                            "255{}",
                            deepest, depth, hidden,
                            is_fixed_point(slice.target) ? " before it becomes a code" : ""))) {
            slice.opaque_depth = depth;
            if (slice.error_bound) *slice.error_bound += hidden;
            if (slice.rounding_bound) *slice.rounding_bound += hidden;
        }
    }

    void choose_sampling() {
        SlicePlan& slice = plan_.slice;
        if (leave_out(facts_.constant && facts_.non_finite == 0 && !scene_.lighting,
                      "volume_texture",
                      "the transfer function is constant over the volume's range: no scalar is "
                      "fetched")) {
            slice.sampling = VolumeSampling::none;
            return;
        }
        const std::uint64_t float_bytes =
            4 * static_cast<std::uint64_t>(facts_.grid.sample_count());
        if (slice.sampling == VolumeSampling::fetch && !slice.integrates_cells() &&
            capabilities_.exact_float_filter && float_bytes <= max_filtered_bytes) {
            slice.sampling = VolumeSampling::filtered;
        }
        slice.float_texture =
            slice.sampling == VolumeSampling::filtered || facts_.type == SampleType::float32;
    }

    void choose_table() {
        SlicePlan& slice = plan_.slice;
        slice.single_color =
            leave_out(facts_.single_color && !scene_.lighting, "color",
                      "one colour in all that can be seen: only extinction is looked up");
        if (slice.classification != Classification::preintegrated) return;
        if (slice.sampling == VolumeSampling::none) {
            leave_out(true, "table",
                      "the transfer function is constant: opacity has a closed form");
            return;
        }
        TableRequest& table = slice.table.request;
        const ValueRange range = drawn_range(*scene_.transfer_function, facts_.range);
        table.lo = range.lo;
        table.hi = range.hi;
        table.colored = !slice.single_color;
        table.lit = scene_.lighting.has_value();
        const double longest =
            (facts_.far_depth - facts_.near_depth) / slice.slabs * facts_.max_length_per_depth;
        table.max_length = longest * slice.unit;
        const double depth = facts_.max_extinction * longest;
        if (leave_out(facts_.pieces == 1 && !table.lit && (!table.colored || depth <= thin_depth),
                      "table",
                      table.colored
                          ? fmt::format("the transfer function is one linear piece and a "
                                        "segment's optical depth at most {:.3g}: its colour has a "
                                        "closed form",
                                        depth)
                          : "the transfer function is one linear piece: optical depth has a closed "
                            "form")) {
            slice.linear = true;
            return;
        }
        if (!table.colored) return;
        if (scene_.slice.table.is_given()) {
            take_table(scene_, facts_, slice.slabs, longest, slice.unit, slice.table, tables_);
            return;
        }
        const bool limit_alone =
            leave_out(depth < short_depth, "length_layers",
                      fmt::format("a segment's optical depth is at most {:.3g}: its colour does "
                                  "not depend on its length",
                                  depth));
        refine_table(scene_, facts_, slice.slabs, limit_alone ? 0 : depth, slice.table, tables_);
    }

    void choose_bricks() {
        SlicePlan& slice = plan_.slice;
        if (slice.sampling == VolumeSampling::none) {
            slice.bricks = {TextureBrick{{0, 0, 0}, facts_.grid.size}};
            return;
        }
        slice.bricks =
            cut_into_bricks(facts_.grid, slice.nan_transparent,
                            texel_bytes(slice, facts_.type, capabilities_), capabilities_);
    }

    void choose_compositing() {
        SlicePlan& slice = plan_.slice;
        if (scene_.target == Target::emulated) slice.emulation = scene_.emulate;
        if (scene_.slice.tree) {
            take_tree(given_tree(scene_.slice.tree));
        } else {
            const int most = most_marched_slabs(scene_, facts_, capabilities_, slice.slabs);
            const bool whole = slice.slabs <= most;
            const std::string node =
                whole ? "one node marches all slabs in registers: "
                      : fmt::format(
                            "nodes march {} slabs in registers, no more fit into this "
                            "driver's loops: ",
                            most);
            if (leave_out(slice.target == Target::float32, "blending",
                          node + "what blending in float32 would give, with one write a pixel and "
                                 "without its roundings")) {
                slice.tree = TreePlan{.factors = {slice.slabs}};
                if (!whole) slice.tree->factors = {(slice.slabs + most - 1) / most, most};
            }
        }
        if (slice.has_tree(NodeArithmetic::shader))
            check_leaves(scene_, TreeShape(slice.tree->factors, slice.slabs),
                         most_marched_slabs(scene_, facts_, capabilities_, slice.slabs),
                         capabilities_);
        if (slice.tree && is_fixed_point(slice.target))
            slice.tree->largest_color = std::max(max_color(), 1.0);
        if (slice.emulation) slice.blending = programmable_blending(capabilities_);
        if (scene_.slice.dither) choose_dither(*scene_.slice.dither);
    }

    // Takes the given tree, or chooses one.
    void take_tree(const TreeSettings* given) {
        SlicePlan& slice = plan_.slice;
        if (given != nullptr) {
            slice.tree = TreePlan{given->factors, given->nodes, given->code, given->alpha_bits};
            check_slice_tree(scene_, facts_.single_color);
            return;
        }
        try {
            const TreeChoice choice = choose_tree(tree_question());
            slice.tree = choice.tree;
            slice.error_bound = choice.error_bound;
            slice.tree_reason = choice.reason;
        } catch (const Error& error) {
            fail("{}: {}", scene_.file.string(), error.what());
        }
    }

    TreeQuestion tree_question() const {
        const SlicePlan& slice = plan_.slice;
        TreeQuestion question;
        question.target = slice.target;
        question.emulation = scene_.emulate;
        question.slabs = slice.slabs;
        const double thickness = (facts_.far_depth - facts_.near_depth) / slice.slabs;
        const DepthRange& seen = facts_.occupied_depth;
        const double visible =
            thickness > 0 ? std::ceil((seen.far - seen.near) / thickness) + 1 : 0.0;
        // A slab that lies in several bricks is composited in parts.
        question.visible_slabs =
            static_cast<int>(std::clamp(visible, 0.0, static_cast<double>(slice.slabs))) +
            static_cast<int>(slice.bricks.size()) - 1;
        question.order = slice.order;
        if (scene_.slice.dither && is_fixed_point(slice.target)) {
            question.dither = dither_of(*scene_.slice.dither, slice.slabs);
        }
        question.largest_color = max_color();
        question.max_error = scene_.max_error;
        question.slab_error = slice.found_error();
        return question;
    }

    void choose_dither(const DitherSettings& settings) {
        SlicePlan& slice = plan_.slice;
        const bool codes = is_fixed_point(slice.target) && !slice.has_tree(NodeArithmetic::shader);
        if (!codes) {
            plan_.omitted.push_back(
                {"dither", "slabs are composited in float: there is nothing to dither"});
            return;
        }
        slice.dither = dither_of(settings, slice.slabs);
    }

    const Scene& scene_;
    const Facts& facts_;
    const SampleTrials& trials_;
    TableCache& tables_;
    const Capabilities& capabilities_;
    const OmissionSwitch& omissions_;
    Plan plan_;
};

}  // namespace

Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables) {
    return SlicePlanner(scene, facts, capabilities, omissions, trials, tables).make();
}

void build_drawn_table(const Scene& scene, const Facts& facts, SlicePlan& plan,
                       TableCache& tables) {
    if (plan.uses_table() && !plan.table.built && !plan.nothing_visible)
        get_table(scene, facts, plan.table, tables);
}

}  // namespace lamina
