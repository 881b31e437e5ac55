// SPDX-License-Identifier: Apache-2.0
#include "plan/planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "compositing/tree_shape.h"
#include "facts/drawn_range.h"
#include "facts/volume_facts.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"
#include "plan/surface_error.h"
#include "scene/camera.h"

namespace lamina {
namespace {

std::uint64_t bytes_of_brick(const TextureBrick& brick, std::uint64_t texel) {
    return static_cast<std::uint64_t>(brick.size[0]) * static_cast<std::uint64_t>(brick.size[1]) *
           static_cast<std::uint64_t>(brick.size[2]) * texel;
}

// Number of draws into which a frame in software is divided, so that it, which may take a minute,
// can show progress and be stopped. The division costs no measurable time.
constexpr int software_batches = 64;

// Ratio of the volume's longest to its shortest side from which on rays are computed in double
// precision, because float32 loses too many digits. In software, doubles cost some 12 % of a frame.
constexpr double thin_box_ratio = 20;

// Least share of the rays' length in the box that must be empty for leaps over empty bricks to pay,
// with the cpu engine and with OpenGL. In OpenGL (llvmpipe, post-classified) hydrogen, .6 % of
// which is empty, took 1.2 times as long with them, and neghip, 30 %, .9 times.
constexpr double least_empty_in_tiles = 0.01, least_empty_in_shaders = 0.2;

constexpr std::uint64_t max_filtered_bytes = std::uint64_t{1} << 30;  // float copies of small types

constexpr double curve_share = 0.25;  // share of max_error that curves may cost

constexpr std::uint64_t gradient_bytes = 8;  // bytes a sample (slicing/gradient_map.h)

// OpenGL's float32 arithmetic changes a ray by at most these shares of full scale: in chords of the
// box (docs/precision.md, "Opacity in float32"), and in each slab by four roundings of 2^-24, of
// its place, its scalar, its opacity and its colour. Those of compositing are counted by
// rounding_bound.
constexpr double chord_rounding = 1e-5, slab_rounding = 0x1p-22;

// Decides how a scene is sliced. make() has the order of its choices, each of which depends on
// those before:
//
//   clip, light    the planes that cut; how far rays may bend in light before they are cut
//   slabs          how many, and whether the texture unit's filter is good enough (by trials)
//   precision      rays in float or in double
//   scalars        how they are fetched; curves in place of the transfer function's pieces
//   integral       whether segments are integrated in closed form or by a table, and which table
//   bricks         textures that hold the volume
//   compositing    a tree or blending, and the bound on its roundings; dithering
//   view           the box that is drawn; regions in one step; the depth at which rays end
struct SlicePlanner {
    const Scene& scene;
    const Facts& facts;
    const Capabilities& capabilities;
    Omissions omissions;
    const SampleTrials& trials;
    TableCache& tables;
    Classification classification = *scene.slice.classification;
    double max_color = largest_drawn_color(scene, facts.max_color);  // after lighting

    Plan make() {
        check_limits(scene, capabilities);
        Plan plan;
        SlicePlan& slice = plan.slice;
        slice.unit = world_unit(box_diagonal(facts.grid));
        slice.target = *scene.target;
        slice.classification = classification;
        slice.order = scene.slice.order;
        slice.batches = capabilities.software ? software_batches : 1;
        slice.nan_transparent = facts.non_finite > 0;
        slice.nearest = facts.grid.lookup == VolumeLookup::nearest;
        slice.table_filtered =
            scene.slice.filter == Filter::hardware || capabilities.exact_float_filter;
        slice.segment_error = exact_segment_error * std::max(max_color, 1.0);

        slice.clip = choose_clip();
        static_cast<LightPlan&>(slice) =
            plan_light(scene, facts.max_color, classification == Classification::exact);

        const bool hardware_filter = choose_slabs(slice);
        if (slice.slab_trial && !capabilities.cpu)
            slice.context_error =
                255 * std::max(max_color, 1.0) * (chord_rounding + slab_rounding * slice.slabs);
        slice.precise_rays = choose_precision();
        slice.sampling = choose_sampling(hardware_filter);
        slice.float_texture =
            slice.sampling == VolumeSampling::filtered ||
            (slice.sampling != VolumeSampling::none && facts.type == SampleType::float32);
        if (slice.integrates_cells()) {
            slice.curve_error = choose_curves();
            choose_surface_error(slice);
        }

        slice.single_color = choose_single_color();
        if (classification == Classification::preintegrated) choose_integral(slice);
        slice.bricks = choose_bricks(slice.sampling, slice.float_texture);
        slice.words = choose_words(slice);
        slice.rays = capabilities.rays;

        if (scene.target == Target::emulated) slice.emulation = scene.emulate;
        const TreeQuestion question =
            tree_question(slice.slabs, slice.bricks.size(), slice.found_error());
        TreeChoice compositing = choose_compositing(question);
        slice.tree = std::move(compositing.tree);
        slice.tree_reason = std::move(compositing.reason);
        slice.error_bound = compositing.error_bound;
        slice.rounding_bound =
            slice.error_bound ? slice.error_bound : rounding_bound(question, slice.tree);
        const bool marched = slice.has_tree(NodeArithmetic::shader);
        if (slice.emulation) slice.blending = code_blending(capabilities);
        if (marched)
            slice.marched_slabs = most_marched_slabs(scene, facts, capabilities, slice.slabs);
        if (slice.blending == Blending::registers)
            slice.marched_slabs = most_coded_slabs(scene, facts, capabilities, slice.slabs);
        slice.dither = choose_dither(question.dither, marched);

        static_cast<ViewPlan&>(slice) = choose_view(marched);
        if (!slice.nothing_visible && slice.sampling != VolumeSampling::none)
            slice.constant_regions = choose_constant_regions(slice.integrates_cells() || marched);
        const bool whole_rays = marched && slice.tree->factors.front() >= slice.slabs;
        if (!slice.nothing_visible && whole_rays)
            slice.opaque_depth = choose_end_of_rays(slice.error_bound);
        if (slice.ends_early()) {
            if (slice.error_bound) *slice.error_bound += hidden_error();
            if (slice.rounding_bound) *slice.rounding_bound += hidden_error();
        }
        plan.omitted = std::move(omissions.list);
        return plan;
    }

    std::vector<IndexPlane> choose_clip() {
        const std::vector<IndexPlane> cutting = cutting_planes(facts.clip, facts.grid);
        const std::size_t all = facts.clip.size(), idle = all - cutting.size();
        const std::string reason =
            fmt::format("{} of {} planes of the clip cut nothing away", idle, all);
        return omissions.leave_out(idle > 0, "clip_planes", reason) ? cutting : facts.clip;
    }

    // Sets the slabs; returns true if the texture unit's filter is taken: if the scene asks for it,
    // or if trials chose it and it was measured to be no worse than the filter that was tried.
    // (Nothing was tried with tables: they keep their fetches.)
    bool choose_slabs(SlicePlan& slice) const {
        const bool given = scene.slice.samples.is_given();
        if (given) {
            slice.slabs = *scene.slice.samples;
        } else {
            const SlabTrial chosen = chosen_slabs(facts, trials);
            slice.slabs = chosen.slabs;
            if (!trials.exact.empty()) slice.slab_trial = chosen;
        }
        const std::optional<SlabTrial> filtered = slabs_of_hardware_filter(trials);
        if (scene.slice.filter.is_given() || !filtered || !capabilities.eight_bit_filter)
            return scene.slice.filter == Filter::hardware;
        slice.filter_reason = fmt::format(
            "one look-up instead of eight: an error of {:.2g} / 255, {}, was found, of "
            "{:.3g} wanted",
            filtered->error, given ? "its own" : "with that of the slabs", filtered->goal);
        if (given) {
            slice.filter_error = filtered->error;
        } else {
            slice.slabs = filtered->slabs;
            slice.slab_trial = filtered;
        }
        return true;
    }

    bool choose_precision() {
        return !omissions.leave_out(
            !capabilities.software && facts.side_ratio < thin_box_ratio, "double_precision",
            "a GPU is slow with doubles and the box is not thin: rays are float32, chords good to "
            "1e-5");
    }

    VolumeSampling choose_sampling(bool hardware_filter) {
        if (omissions.leave_out(
                facts.constant && facts.non_finite == 0 && !scene.lighting, "volume_texture",
                "the transfer function is constant over the volume's range: no scalar is fetched"))
            return VolumeSampling::none;
        if (hardware_filter) return VolumeSampling::hardware;
        const std::uint64_t float_bytes = 4 * static_cast<std::uint64_t>(facts.grid.sample_count());
        const bool filtered = classification != Classification::exact &&
                              capabilities.exact_float_filter && float_bytes <= max_filtered_bytes;
        return filtered ? VolumeSampling::filtered : VolumeSampling::fetch;
    }

    // Returns the error, in 1/255, of curves in place of straight pieces (optics/pieces.h); 0 if
    // there are none: no smooth point, too small a max_error, or OpenGL.
    double choose_curves() {
        const double error = largest_curve_error * std::max(facts.max_color, 1.0);
        const bool pay = capabilities.cpu && facts.curves != facts.pieces &&
                         error <= curve_share * scene.max_error;
        const bool taken = omissions.leave_out(
            pay, "smooth_points",
            fmt::format("{} cubics follow {} straight pieces of the transfer function, which meet "
                        "at smooth points: off by at most {:.2g} / 255",
                        facts.curves, facts.pieces, error));
        return taken ? error : 0;
    }

    // Sets the errors of rays along surfaces.
    void choose_surface_error(SlicePlan& slice) const {
        const double brightest = std::max(max_color, 1.0);
        const double counted = exact_segment_error * brightest;  // by segment_error
        const SurfaceError found = surface_error(scene, facts);
        const double steps = 255 * brightest * found.steps, all = 255 * brightest * found.all;
        const auto fits = [&](double error) {
            return slice.found_error() + error <= scene.max_error;
        };
        if (all <= counted || fits(all)) {
            slice.surface_error = all <= counted ? 0 : all;
            return;
        }
        slice.ramp_error = all;
        if (steps > counted)
            slice.surface_error = fits(steps) ? steps : std::numeric_limits<double>::infinity();
    }

    bool choose_single_color() {
        return omissions.leave_out(
            facts.single_color && !scene.lighting, "color",
            "one colour in all that can be seen: only extinction is looked up");
    }

    void choose_integral(SlicePlan& slice) {
        if (slice.sampling == VolumeSampling::none) {
            omissions.leave_out(true, "table",
                                "the transfer function is constant: opacity has a closed form");
            return;
        }
        TableRequest& table = slice.table.request;
        const ValueRange range = drawn_range(*scene.transfer_function, facts.range);
        table.lo = range.lo;
        table.hi = range.hi;
        table.colored = !slice.single_color;
        table.lit = scene.lighting.has_value();
        const double longest =
            (facts.far_depth - facts.near_depth) / slice.slabs * facts.max_length_per_depth;
        table.max_length = longest * slice.unit;
        const double depth = facts.max_extinction * longest;
        slice.linear = omissions.leave_out(
            facts.pieces == 1 && !table.lit && (!table.colored || depth <= thin_depth), "table",
            table.colored
                ? fmt::format("the transfer function is one linear piece and a segment's optical "
                              "depth at most {:.3g}: its colour has a closed form",
                              depth)
                : "the transfer function is one linear piece: optical depth has a closed form");
        if (slice.linear || !table.colored) return;
        if (scene.slice.table.is_given()) {
            take_table(scene, facts, slice.slabs, longest, slice.unit, slice.table, tables);
            return;
        }
        const bool limit_alone = omissions.leave_out(
            depth < short_depth, "length_layers",
            fmt::format("a segment's optical depth is at most {:.3g}: its colour does not depend "
                        "on its length",
                        depth));
        refine_table(scene, facts, slice.slabs, limit_alone ? 0 : depth, slice.table, tables);
    }

    // Cuts the volume into bricks. If it is lit, OpenGL's largest texels are those of gradients.
    std::vector<TextureBrick> choose_bricks(VolumeSampling sampling, bool float_texture) const {
        if (sampling == VolumeSampling::none) return {TextureBrick{{0, 0, 0}, facts.grid.size}};
        const std::uint64_t sample_bytes = float_texture ? 4 : bytes_of(facts.type);
        const bool gradients = scene.lighting && !capabilities.cpu;
        // Voxels that are constant have no border samples beside them.
        const bool bordered = facts.non_finite > 0 && facts.grid.lookup == VolumeLookup::linear;
        return cut_into_bricks(facts.grid, bordered, gradients ? gradient_bytes : sample_bytes,
                               capabilities);
    }

    // Tells whether cells are read from words of storage buffers: if they are exact and fit.
    bool choose_words(const SlicePlan& slice) const {
        const std::uint64_t sample_bytes = slice.float_texture ? 4 : bytes_of(facts.type);
        const auto fits = [&](const TextureBrick& brick) {
            return bytes_of_brick(brick, sample_bytes) <=
                   static_cast<std::uint64_t>(capabilities.max_storage_bytes);
        };
        return !capabilities.cpu && capabilities.sample_words.value_or(capabilities.software) &&
               slice.integrates_cells() && std::ranges::all_of(slice.bricks, fits);
    }

    TreeQuestion tree_question(int slabs, std::size_t bricks, double slab_error) const {
        TreeQuestion question;
        question.target = *scene.target;
        question.emulation = scene.emulate;
        question.slabs = slabs;
        const double thickness = (facts.far_depth - facts.near_depth) / slabs;
        const DepthRange& seen = facts.occupied_depth;
        const double visible =
            thickness > 0 ? std::ceil((seen.far - seen.near) / thickness) + 1 : 0.0;
        // A slab that lies in several bricks is composited in several draws.
        question.visible_slabs =
            static_cast<int>(std::clamp(visible, 0.0, static_cast<double>(slabs))) +
            static_cast<int>(bricks) - 1;
        question.order = scene.slice.order;
        if (scene.slice.dither && is_fixed_point(question.target))
            question.dither = dither_of(*scene.slice.dither, slabs);
        question.largest_color = max_color;
        question.max_error = scene.max_error;
        question.slab_error = slab_error;
        return question;
    }

    // Returns the scene's tree, or the choice of an automatic one, or for float32 one node that
    // marches all slabs in registers.
    TreeChoice choose_compositing(const TreeQuestion& question) {
        TreeChoice choice;
        if (const TreeSettings* const given = given_tree(scene.slice.tree)) {
            choice.tree = TreePlan{given->factors, given->nodes, given->code, given->alpha_bits};
            check_slice_tree(scene, facts.single_color);
        } else if (scene.slice.tree) {
            try {
                choice = choose_tree(question);
            } catch (const Error& error) {
                fail("{}: {}", scene.file.string(), error.what());
            }
        } else if (omissions.leave_out(
                       question.target == Target::float32, "blending",
                       "one node marches all slabs in registers: what blending in float32 would "
                       "give, with one write a pixel and without its roundings")) {
            choice.tree = TreePlan{.factors = {question.slabs}};
        }
        if (!choice.tree) return choice;
        if (is_fixed_point(question.target)) choice.tree->largest_color = std::max(max_color, 1.0);
        return choice;
    }

    // `of_codes`: the dithering of a fixed-point target, if the scene asks for any.
    std::optional<Dither> choose_dither(const std::optional<Dither>& of_codes, bool marched) {
        if (!scene.slice.dither) return {};
        if (of_codes && !marched) return of_codes;
        omissions.list.push_back(
            {"dither", "slabs are composited in float: there is nothing to dither"});
        return {};
    }

    ViewPlan choose_view(bool marched) {
        ViewPlan view;
        view.orthographic = omissions.leave_out(
            facts.orthographic, "perspective",
            "parallel rays: one direction and one length per depth for all fragments");
        const IndexBox whole{facts.grid.index_min(), facts.grid.index_max()};
        view.drawn = whole;
        view.nothing_visible = omissions.leave_out(
            facts.occupied.empty() || facts.far_depth <= facts.near_depth, "drawing",
            facts.clipped_away       ? "the clip cuts all away that the transfer function shows"
            : facts.occupied.empty() ? "the transfer function shows no value that the volume has"
                                     : "the volume lies behind the eye");
        if (view.nothing_visible) return view;
        const bool smaller = facts.occupied.min != whole.min || facts.occupied.max != whole.max;
        const bool by_brick = skips_bricks(marched);
        if (omissions.leave_out(
                (smaller || by_brick) && !facts.occupied.empty(), "empty_space",
                fmt::format("only {} of the bricks of {}^3 cells can be seen: {}",
                            percent_text(facts.occupied_share), MinMaxBricks::edge,
                            by_brick
                                ? fmt::format("rays leap over the others, by a map of {} bytes",
                                              facts.occupied_bricks.distance.size())
                                : "slabs are drawn in the box around them"))) {
            view.drawn = facts.occupied;
            view.occupied_only = by_brick;
        }
        return view;
    }

    // Tells whether rays leap over empty bricks: if enough of their length is empty. Pre-integrated
    // volumes with NaN are excluded: between two empty bricks with NaN between them the scalar may
    // jump across a visible value, and a segment from one into the other would show it.
    bool skips_bricks(bool marched) const {
        const bool jumps = facts.non_finite > 0 && classification == Classification::preintegrated;
        const std::int64_t longest = std::ranges::max(facts.occupied_bricks.count);
        const bool leaps =
            capabilities.cpu ||
            (marched && longest <= capabilities.max_3d_texture_size &&
             facts.occupied_bricks.distance.size() <= capabilities.max_texture_bytes);
        const RayShares& shares = facts.ray_shares;
        const double least = capabilities.cpu ? least_empty_in_tiles : least_empty_in_shaders;
        const bool pays = shares.occupied <= (1 - least) * shares.box;
        return leaps && pays && facts.occupied_share < 1 && !jumps;
    }

    // Tells whether rays cross constant regions in one step: not if slabs are rounded to codes one
    // by one. In OpenGL, measured in software, finding these regions costs more than it saves.
    bool choose_constant_regions(bool one_program) {
        const ConstantBricks& constant = facts.constant_bricks;
        return omissions.leave_out(
            capabilities.cpu && one_program && !constant.kinds.empty() && !scene.lighting,
            "constant_regions",
            fmt::format("{} of the bricks that show something have one colour and one extinction: "
                        "rays take them in one step, by maps of {} bytes",
                        percent_text(constant.share), 2 * constant.kind.size()));
    }

    // Returns the optical depth at which rays end, or infinity. Only a ray that one node marches
    // from end to end can end early.
    double choose_end_of_rays(const std::optional<double>& error_bound) {
        constexpr double never = std::numeric_limits<double>::infinity();
        if (error_bound && *error_bound + hidden_error() > scene.max_error) return never;
        const double depth = opaque_depth(scene.max_error, max_color);
        const RayShares& shares = facts.ray_shares;
        const bool ends = omissions.leave_out(
            shares.box_before_opaque < shares.box, "early_termination",
            fmt::format("rays end at an optical depth of {:.3g}: what lies behind changes no "
                        "channel by more than {:.2g} / 255{}",
                        depth, hidden_error(),
                        is_fixed_point(*scene.target) ? " before it becomes a code" : ""));
        return ends ? depth : never;
    }

    // Returns the error of rays that end at opaque_depth(), in 1/255.
    double hidden_error() const { return hidden_share * scene.max_error; }
};

}  // namespace

std::vector<TextureBrick> cut_into_bricks(const Grid& grid, bool bordered,
                                          std::uint64_t texel_bytes,
                                          const Capabilities& capabilities) {
    std::array<std::int64_t, 3> samples = grid.size, border{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        border[axis] = bordered && grid.index_min()[static_cast<int>(axis)] < 0 ? 1 : 0;
        samples[axis] += 2 * border[axis];
    }
    std::array<std::int64_t, 3> parts{1, 1, 1}, cells{};
    TextureBrick largest;
    while (true) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int64_t all = std::max<std::int64_t>(samples[axis] - 1, 1);
            cells[axis] = (all + parts[axis] - 1) / parts[axis];
            largest.size[axis] = std::min(cells[axis] + 1, samples[axis]);
        }
        const std::size_t longest = static_cast<std::size_t>(
            std::max_element(largest.size.begin(), largest.size.end()) - largest.size.begin());
        if (largest.size[longest] <= capabilities.max_3d_texture_size &&
            bytes_of_brick(largest, texel_bytes) <= capabilities.max_texture_bytes) {
            break;
        }
        if (largest.size[longest] <= 2) {
            fail("volume: a brick of {} bytes does not fit a texture of {}: {}",
                 bytes_of_brick(largest, texel_bytes), capabilities.max_texture_bytes,
                 capabilities.renderer);
        }
        ++parts[longest];
    }
    std::vector<TextureBrick> bricks;
    std::array<std::int64_t, 3> at{};
    const auto last_cell = [&](std::size_t axis) {
        return std::max<std::int64_t>(samples[axis] - 1, 1);
    };
    for (at[2] = 0; at[2] < last_cell(2); at[2] += cells[2]) {
        for (at[1] = 0; at[1] < last_cell(1); at[1] += cells[1]) {
            for (at[0] = 0; at[0] < last_cell(0); at[0] += cells[0]) {
                TextureBrick brick{at, {}, bordered};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    brick.size[axis] = std::min(cells[axis] + 1, samples[axis] - at[axis]);
                    brick.first[axis] -= border[axis];
                }
                bricks.push_back(brick);
            }
        }
    }
    return bricks;
}

Plan plan_slicing(const Scene& scene, const Facts& facts, const Capabilities& capabilities,
                  const OmissionSwitch& omissions, const SampleTrials& trials, TableCache& tables) {
    return SlicePlanner{scene, facts, capabilities, {omissions}, trials, tables}.make();
}

void build_drawn_table(const Scene& scene, const Facts& facts, SlicePlan& plan,
                       TableCache& tables) {
    if (plan.uses_table() && !plan.table.built && !plan.nothing_visible)
        get_table(scene, facts, plan.table, tables);
}

}  // namespace lamina
