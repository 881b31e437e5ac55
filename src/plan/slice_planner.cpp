// SPDX-License-Identifier: Apache-2.0
#include "plan/planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "compositing/tree_shape.h"
#include "facts/drawn_range.h"
#include "facts/rays.h"
#include "facts/world_unit.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"
#include "plan/light_choice.h"
#include "plan/march_limit.h"
#include "plan/slab_choice.h"
#include "plan/table_choice.h"
#include "plan/target_choice.h"

namespace lamina {
namespace {

// Number of draws of a software frame, which may take a minute, so that it can show progress and be
// stopped. It costs no time that could be measured.
constexpr int software_batches = 64;

// Ratio of a box's sides whose digits rays lose in float32; from it on they are computed in double.
// In software, doubles cost some 12 % of a frame.
constexpr double thin_box_ratio = 20;

// Shares of a ray that must be empty for leaps over empty bricks to pay. In OpenGL (llvmpipe,
// post-classified) hydrogen, .6 % of which is empty, took 1.2 times as long with them, and neghip,
// 30 %, .9 times.
constexpr double least_empty_in_tiles = 0.01, least_empty_in_shaders = 0.2;

constexpr std::uint64_t max_filtered_bytes = std::uint64_t{1} << 30;  // float copies of small types

constexpr double curve_share = 0.25;  // share of max_error that curves may cost

constexpr std::uint64_t gradient_bytes = 8;  // of a sample (slicing/gradient_map.h)

// Decides how a scene is sliced. make() has the order of its choices, each of which depends on
// those before:
//
//   clip, light    the planes that cut; how far rays may bend in light before they are cut
//   slabs          how many, and whether the texture unit's filter is good enough (by trials)
//   precision      rays in float or in double
//   scalars        how they are fetched; curves in place of the transfer function's pieces
//   integral       of segments: in closed form, or which table
//   bricks         textures that hold the volume
//   compositing    a tree or blending, and the bound on its roundings; dithering
//   view           the box that is drawn; regions in one step; the depth at which rays end
class SlicePlanner {
  public:
    SlicePlanner(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                 const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables)
        : scene_(scene),
          facts_(facts),
          trials_(trials),
          tables_(tables),
          capabilities_(capabilities),
          omissions_{omissions},
          classification_(*scene.slice.classification),
          max_color_(largest_drawn_color(scene, facts.max_color)) {}

    Plan make() {
        check_limits(scene_, capabilities_);
        Plan plan;
        SlicePlan& slice = plan.slice;
        slice.unit = world_unit(box_diagonal(facts_.grid));
        slice.target = *scene_.target;
        slice.classification = classification_;
        slice.order = scene_.slice.order;
        slice.batches = capabilities_.software ? software_batches : 1;
        slice.nan_transparent = facts_.non_finite > 0;
        slice.table_filtered =
            scene_.slice.filter == Filter::hardware || capabilities_.exact_float_filter;
        slice.segment_error = exact_segment_error * std::max(max_color_, 1.0);

        slice.clip = choose_clip();
        static_cast<LightPlan&>(slice) =
            plan_light(scene_, facts_.max_color, classification_ == Classification::exact);

        SlabChoice slabs = choose_slabs();
        slice.slabs = slabs.slabs;
        slice.slab_trial = slabs.trial;
        slice.filter_reason = std::move(slabs.filter_reason);
        slice.filter_error = slabs.filter_error;

        slice.precise_rays = choose_precision();
        slice.sampling = choose_sampling(slabs.hardware_filter);
        slice.float_texture =
            slice.sampling == VolumeSampling::filtered ||
            (slice.sampling != VolumeSampling::none && facts_.type == SampleType::float32);
        if (slice.integrates_cells()) slice.curve_error = choose_curves();

        slice.single_color = choose_single_color();
        if (classification_ == Classification::preintegrated) {
            IntegralChoice integral =
                choose_integral(slice.sampling, slice.slabs, slice.unit, slice.single_color);
            slice.linear = integral.linear;
            slice.table = std::move(integral.table);
        }
        slice.bricks = choose_bricks(slice.sampling, slice.float_texture);

        if (scene_.target == Target::emulated) {
            slice.emulation = scene_.emulate;
            slice.blending = programmable_blending(capabilities_);
        }
        const TreeQuestion question =
            tree_question(slice.slabs, slice.bricks.size(), slice.found_error());
        TreeChoice compositing = choose_compositing(question);
        slice.tree = std::move(compositing.tree);
        slice.tree_reason = std::move(compositing.reason);
        slice.error_bound = compositing.error_bound;
        slice.rounding_bound =
            slice.error_bound ? slice.error_bound : rounding_bound(question, slice.tree);
        const bool marched = slice.has_tree(NodeArithmetic::shader);
        slice.dither = choose_dither(question.dither, marched);

        static_cast<ViewPart&>(slice) = choose_view(marched);
        if (!slice.nothing_visible && slice.sampling != VolumeSampling::none)
            slice.constant_regions = choose_constant_regions(slice.integrates_cells() || marched);
        const bool whole_rays = marched && slice.tree->factors.front() >= slice.slabs;
        if (!slice.nothing_visible && whole_rays)
            slice.opaque_depth = choose_end_of_rays(slice.bricks.size(), slice.error_bound);
        if (slice.ends_early()) {
            if (slice.error_bound) *slice.error_bound += hidden_error();
            if (slice.rounding_bound) *slice.rounding_bound += hidden_error();
        }
        plan.omitted = std::move(omissions_.list);
        return plan;
    }

  private:
    std::vector<IndexPlane> choose_clip() {
        const std::vector<IndexPlane> cutting = cutting_planes(facts_.clip, facts_.grid);
        const std::size_t all = facts_.clip.size(), idle = all - cutting.size();
        const std::string reason =
            fmt::format("{} of {} planes of the clip cut nothing away", idle, all);
        return omissions_.leave_out(idle > 0, "clip_planes", reason) ? cutting : facts_.clip;
    }

    struct SlabChoice {
        int slabs = 1;
        std::optional<SlabTrial> trial;
        bool hardware_filter = false;
        std::string filter_reason;
        double filter_error = 0;
    };

    // The texture unit's filter is taken if it was measured to be no worse than the one that was
    // tried. (Nothing was tried with tables: they keep their fetches.)
    SlabChoice choose_slabs() const {
        SlabChoice choice;
        const bool given = scene_.slice.samples.is_given();
        if (given) {
            choice.slabs = *scene_.slice.samples;
        } else {
            const SlabTrial chosen = chosen_slabs(facts_, trials_);
            choice.slabs = chosen.slabs;
            if (!trials_.exact.empty()) choice.trial = chosen;
        }
        choice.hardware_filter = scene_.slice.filter == Filter::hardware;
        const std::optional<SlabTrial> filtered = slabs_of_hardware_filter(trials_);
        if (scene_.slice.filter.is_given() || !filtered || !capabilities_.eight_bit_filter)
            return choice;
        choice.hardware_filter = true;
        choice.filter_reason = fmt::format(
            "one look-up instead of eight: an error of {:.2g} / 255, {}, was found, of "
            "{:.3g} wanted",
            filtered->error, given ? "its own" : "with that of the slabs", filtered->goal);
        if (given) {
            choice.filter_error = filtered->error;
        } else {
            choice.slabs = filtered->slabs;
            choice.trial = filtered;
        }
        return choice;
    }

    bool choose_precision() {
        return !omissions_.leave_out(
            !capabilities_.software && facts_.side_ratio < thin_box_ratio, "double_precision",
            "a GPU is slow with doubles and the box is not thin: rays are float32, chords good to "
            "1e-5");
    }

    VolumeSampling choose_sampling(bool hardware_filter) {
        if (omissions_.leave_out(
                facts_.constant && facts_.non_finite == 0 && !scene_.lighting, "volume_texture",
                "the transfer function is constant over the volume's range: no scalar is fetched"))
            return VolumeSampling::none;
        if (hardware_filter) return VolumeSampling::hardware;
        const std::uint64_t float_bytes =
            4 * static_cast<std::uint64_t>(facts_.grid.sample_count());
        const bool filtered = classification_ != Classification::exact &&
                              capabilities_.exact_float_filter && float_bytes <= max_filtered_bytes;
        return filtered ? VolumeSampling::filtered : VolumeSampling::fetch;
    }

    // Returns the error, in 1/255, of curves in place of straight pieces (optics/pieces.h).
    // It is 0, and there are none, if no point of the transfer function is smooth or max_error is
    // too small.
    double choose_curves() {
        const double error = largest_curve_error * std::max(facts_.max_color, 1.0);
        const bool pay = capabilities_.tiles && facts_.curves != facts_.pieces &&
                         error <= curve_share * scene_.max_error;
        const bool taken = omissions_.leave_out(
            pay, "smooth_points",
            fmt::format("{} cubics follow {} straight pieces of the transfer function, which meet "
                        "at smooth points: off by at most {:.2g} / 255",
                        facts_.curves, facts_.pieces, error));
        return taken ? error : 0;
    }

    bool choose_single_color() {
        return omissions_.leave_out(
            facts_.single_color && !scene_.lighting, "color",
            "one colour in all that can be seen: only extinction is looked up");
    }

    struct IntegralChoice {
        bool linear = false;
        TablePlan table;
    };

    IntegralChoice choose_integral(VolumeSampling sampling, int slabs, double unit,
                                   bool single_color) {
        IntegralChoice choice;
        if (sampling == VolumeSampling::none) {
            omissions_.leave_out(true, "table",
                                 "the transfer function is constant: opacity has a closed form");
            return choice;
        }
        TableRequest& table = choice.table.request;
        const ValueRange range = drawn_range(*scene_.transfer_function, facts_.range);
        table.lo = range.lo;
        table.hi = range.hi;
        table.colored = !single_color;
        table.lit = scene_.lighting.has_value();
        const double longest =
            (facts_.far_depth - facts_.near_depth) / slabs * facts_.max_length_per_depth;
        table.max_length = longest * unit;
        const double depth = facts_.max_extinction * longest;
        choice.linear = omissions_.leave_out(
            facts_.pieces == 1 && !table.lit && (!table.colored || depth <= thin_depth), "table",
            table.colored
                ? fmt::format("the transfer function is one linear piece and a segment's optical "
                              "depth at most {:.3g}: its colour has a closed form",
                              depth)
                : "the transfer function is one linear piece: optical depth has a closed form");
        if (choice.linear || !table.colored) return choice;
        if (scene_.slice.table.is_given()) {
            take_table(scene_, facts_, slabs, longest, unit, choice.table, tables_);
            return choice;
        }
        const bool limit_alone = omissions_.leave_out(
            depth < short_depth, "length_layers",
            fmt::format("a segment's optical depth is at most {:.3g}: its colour does not depend "
                        "on its length",
                        depth));
        refine_table(scene_, facts_, slabs, limit_alone ? 0 : depth, choice.table, tables_);
        return choice;
    }

    // OpenGL keeps the gradients of lit volumes in textures, too; these then have the largest
    // texels.
    std::vector<TextureBrick> choose_bricks(VolumeSampling sampling, bool float_texture) const {
        if (sampling == VolumeSampling::none) return {TextureBrick{{0, 0, 0}, facts_.grid.size}};
        const std::uint64_t sample_bytes = float_texture ? 4 : bytes_of(facts_.type);
        const bool gradients = scene_.lighting && !capabilities_.tiles;
        return cut_into_bricks(facts_.grid, facts_.non_finite > 0,
                               gradients ? gradient_bytes : sample_bytes, capabilities_);
    }

    TreeQuestion tree_question(int slabs, std::size_t bricks, double slab_error) const {
        TreeQuestion question;
        question.target = *scene_.target;
        question.emulation = scene_.emulate;
        question.slabs = slabs;
        const double thickness = (facts_.far_depth - facts_.near_depth) / slabs;
        const DepthRange& seen = facts_.occupied_depth;
        const double visible =
            thickness > 0 ? std::ceil((seen.far - seen.near) / thickness) + 1 : 0.0;
        // A slab that lies in several bricks is composited in several draws.
        question.visible_slabs =
            static_cast<int>(std::clamp(visible, 0.0, static_cast<double>(slabs))) +
            static_cast<int>(bricks) - 1;
        question.order = scene_.slice.order;
        if (scene_.slice.dither && is_fixed_point(question.target))
            question.dither = dither_of(*scene_.slice.dither, slabs);
        question.largest_color = max_color_;
        question.max_error = scene_.max_error;
        question.slab_error = slab_error;
        return question;
    }

    // Returns the scene's tree, or the choice of an automatic one, or for float32 the one that
    // marches as many slabs in registers as it can.
    TreeChoice choose_compositing(const TreeQuestion& question) {
        const int slabs = question.slabs;
        const auto most_marched = [&] {
            return most_marched_slabs(scene_, facts_, capabilities_, slabs);
        };
        TreeChoice choice;
        if (const TreeSettings* const given = given_tree(scene_.slice.tree)) {
            choice.tree = TreePlan{given->factors, given->nodes, given->code, given->alpha_bits};
            check_slice_tree(scene_, facts_.single_color);
        } else if (scene_.slice.tree) {
            try {
                choice = choose_tree(question);
            } catch (const Error& error) {
                fail("{}: {}", scene_.file.string(), error.what());
            }
        } else {
            const int most = most_marched();
            const bool whole = slabs <= most;
            const std::string node =
                whole ? "one node marches all slabs in registers: "
                      : fmt::format(
                            "nodes march {} slabs in registers, no more fit into this "
                            "driver's loops: ",
                            most);
            if (omissions_.leave_out(question.target == Target::float32, "blending",
                                     node + "what blending in float32 would give, with one write "
                                            "a pixel and without its roundings")) {
                choice.tree = TreePlan{.factors = {slabs}};
                if (!whole) choice.tree->factors = {(slabs + most - 1) / most, most};
            }
        }
        if (!choice.tree) return choice;
        if (choice.tree->nodes == NodeArithmetic::shader)
            check_leaves(scene_, TreeShape(choice.tree->factors, slabs), most_marched(),
                         capabilities_);
        if (is_fixed_point(question.target)) choice.tree->largest_color = std::max(max_color_, 1.0);
        return choice;
    }

    // `of_codes`: the dithering of a fixed-point target, if the scene asks for any.
    std::optional<Dither> choose_dither(const std::optional<Dither>& of_codes, bool marched) {
        if (!scene_.slice.dither) return {};
        if (of_codes && !marched) return of_codes;
        omissions_.list.push_back(
            {"dither", "slabs are composited in float: there is nothing to dither"});
        return {};
    }

    ViewPart choose_view(bool marched) {
        ViewPart view;
        view.orthographic = omissions_.leave_out(
            facts_.orthographic, "perspective",
            "parallel rays: one direction and one length per depth for all fragments");
        const IndexBox whole{facts_.grid.index_min(), facts_.grid.index_max()};
        view.drawn = whole;
        view.nothing_visible = omissions_.leave_out(
            facts_.occupied.empty() || facts_.far_depth <= facts_.near_depth, "drawing",
            facts_.clipped_away       ? "the clip cuts all away that the transfer function shows"
            : facts_.occupied.empty() ? "the transfer function shows no value that the volume has"
                                      : "the volume lies behind the eye");
        if (view.nothing_visible) return view;
        const bool smaller = facts_.occupied.min != whole.min || facts_.occupied.max != whole.max;
        const bool by_brick = skips_bricks(marched);
        if (omissions_.leave_out(
                (smaller || by_brick) && !facts_.occupied.empty(), "empty_space",
                fmt::format("only {} of the bricks of {}^3 cells can be seen: {}",
                            percent_text(facts_.occupied_share), MinMaxBricks::edge,
                            by_brick
                                ? fmt::format("rays leap over the others, by a map of {} bytes",
                                              facts_.occupied_bricks.distance.size())
                                : "slabs are drawn in the box around them"))) {
            view.drawn = facts_.occupied;
            view.occupied_only = by_brick;
        }
        return view;
    }

    // Skips empty bricks if a large enough share is empty. Two empty bricks with NaN between them
    // count as visible: the scalar may jump across a visible value there, and a segment from one
    // into the other would show it.
    bool skips_bricks(bool marched) const {
        const bool jumps =
            facts_.non_finite > 0 && classification_ == Classification::preintegrated;
        const std::int64_t longest = std::ranges::max(facts_.occupied_bricks.count);
        const bool leaps =
            capabilities_.tiles ||
            (marched && longest <= capabilities_.max_3d_texture_size &&
             facts_.occupied_bricks.distance.size() <= capabilities_.max_texture_bytes);
        const RayShares& shares = facts_.ray_shares;
        const double least = capabilities_.tiles ? least_empty_in_tiles : least_empty_in_shaders;
        const bool pays = shares.occupied <= (1 - least) * shares.box;
        return leaps && pays && facts_.occupied_share < 1 && !jumps;
    }

    // Codes are those of single slabs. In OpenGL, measured in software, finding the constant
    // regions takes longer than they save.
    bool choose_constant_regions(bool one_program) {
        const ConstantBricks& constant = facts_.constant_bricks;
        return omissions_.leave_out(
            capabilities_.tiles && one_program && !constant.kinds.empty() && !scene_.lighting,
            "constant_regions",
            fmt::format("{} of the bricks that show something have one colour and one extinction: "
                        "rays take them in one step, by maps of {} bytes",
                        percent_text(constant.share), 2 * constant.kind.size()));
    }

    // Returns the optical depth at which rays end that one program marches whole. In a tree, the
    // part of a ray behind a leaf belongs to another leaf; on OpenGL with several bricks, to
    // another program.
    double choose_end_of_rays(std::size_t bricks, const std::optional<double>& error_bound) {
        constexpr double never = std::numeric_limits<double>::infinity();
        if (!capabilities_.tiles && bricks > 1) return never;
        if (error_bound && *error_bound + hidden_error() > scene_.max_error) return never;
        const double depth = opaque_depth(scene_.max_error, max_color_);
        const DepthRange& seen = facts_.occupied_depth;
        const double deepest =
            facts_.max_extinction * (seen.far - seen.near) * facts_.max_length_per_depth;
        const RayShares& shares = facts_.ray_shares;
        const bool ends = omissions_.leave_out(
            deepest > depth && shares.box_before_opaque < shares.box, "early_termination",
            fmt::format("rays may get {:.3g} deep and end at an optical depth of {:.3g}: what lies "
                        "behind changes no channel by more than {:.2g} / 255{}",
                        deepest, depth, hidden_error(),
                        is_fixed_point(*scene_.target) ? " before it becomes a code" : ""));
        return ends ? depth : never;
    }

    // Returns the error of rays that end at opaque_depth(), in 1/255.
    double hidden_error() const { return hidden_share * scene_.max_error; }

    const Scene& scene_;
    const Facts& facts_;
    const SampleTrials& trials_;
    TableCache& tables_;
    const Capabilities& capabilities_;
    Omissions omissions_;
    Classification classification_;
    double max_color_;  // largest component that may be drawn
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
