// SPDX-License-Identifier: Apache-2.0
#include "plan/planners.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/vec4.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/enum_words.h"
#include "base/error.h"
#include "base/parallel.h"
#include "facts/drawn_range.h"
#include "optics/opacity.h"
#include "optics/optics_change.h"
#include "optics/pieces.h"
#include "optics/segment_integral.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lamina {
namespace {

// Distance of the near plane from the eye, as a share of the mesh's diagonal (docs/numerics.md,
// section 7). Scene files have no near plane.
constexpr double near_share = 1e-6;

// Error of float32 arithmetic, in 1/255: equal to exact_segment_error (plan/choices.h).
constexpr double float_error = 0.05;

// Share of a tet's longest edge by which faces at both ends of a segment are assumed to be out of
// place. The bound is 9e-6 (docs/stability.md). Most faces stay far below it, because their planes
// have double precision and are given relative to a pixel nearby.
constexpr double placing_share = 1e-6;

// Error, in 1/255, above which no error is stated, because a few rays tell little of pictures that
// are so far off.
constexpr double most_figure = 8;

// Largest error, in 1/255, that a pre-integration table may add to the picture.
constexpr double most_segment_error = 0.5;

// Factor by which other rays of the picture may be worse than the trial rays. If the scene asks for
// a table and not all pixels are tried, it is at least this root of the pixels for each trial ray,
// as for trials of slabs (slab_error_goal() in plan/choices.h).
constexpr double sampling_margin = 1.25, sampling_root = 0.25;

// Tets are cut into cell fragments at the transfer function's points only if a visible tet has at
// most this many on average. With more, a table whose nodes lie on these points is faster.
constexpr std::int64_t most_cell_fragments_a_tet = 8;

// Number of points of a transfer function above which a table takes longer to build than it saves.
constexpr std::size_t most_table_points = 200;

// Number of tets below which depths on faces are always found in double precision (about a third
// slower): one tet may fill the picture, with a face that many rays meet at a grazing angle.
constexpr std::int64_t fewest_plain_tets = 10000;

// Ratio of the range of scalars to the window of visible ones from which on scalars are normalised
// to the window. Below this ratio no more than 3 of float32's 24 bits are lost.
constexpr double least_narrowing = 8;

bool is_far_narrower(const ValueRange& window, const ValueRange& range) {
    return (range.hi - range.lo) / least_narrowing > window.hi - window.lo;
}

// If the range of scalars is wider than the median visible piece of the transfer function by more
// than this ratio, and no window is used, tets are cut, into however many pieces: in float32,
// scalars of the whole range would resolve only 1e-3 of a piece.
constexpr double narrow_pieces = 0x1p12;

// Tells whether the range is wider than the median visible linear piece by more than that ratio.
bool has_narrow_pieces(const TransferFunction& transfer_function, const ValueRange& range) {
    std::vector<double> widths;
    for_each_linear_piece(transfer_function.knots(), range.lo, range.hi,
                          [&](const LinearPiece& piece) {
                              if (piece.at_from.extinction > 0 || piece.at_to.extinction > 0)
                                  widths.push_back(piece.to - piece.from);
                          });
    if (widths.empty()) return false;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::ranges::nth_element(widths, middle);
    return *middle * narrow_pieces < range.hi - range.lo;
}

// Cuts a segment at the ends of the window and calls visit() with each part, front to back. Parts
// outside the window get the constant scalar of its nearer end, as renderers draw them.
template <typename Visit>
void for_each_piece_of_window(const MeshFacts::Segment& segment, const ValueRange& window,
                              const Visit& visit) {
    const double in = std::clamp(segment.front, window.lo, window.hi),
                 out = std::clamp(segment.back, window.lo, window.hi);
    if (in == out) return visit(MeshFacts::Segment{in, out, segment.length});
    const auto length = [&](double from, double to) {
        return segment.length * ((to - from) / (segment.back - segment.front));
    };
    if (in != segment.front) visit(MeshFacts::Segment{in, in, length(segment.front, in)});
    const bool whole = in == segment.front && out == segment.back;
    visit(MeshFacts::Segment{in, out, whole ? segment.length : length(in, out)});
    if (out != segment.back) visit(MeshFacts::Segment{out, out, length(out, segment.back)});
}

OrderMethod method_of(ProjectOrder order) {
    switch (order) {
        case ProjectOrder::mpvo:
            return OrderMethod::mpvo;
        case ProjectOrder::exact:
            return OrderMethod::exact;
        case ProjectOrder::centroid:
            return OrderMethod::centroid;
        case ProjectOrder::none:
            return OrderMethod::none;
    }
    unreachable_enum();
}

// Decides how a mesh is projected. make() has the order of its choices, each of which depends on
// those before:
//
//   geometry       silhouettes or fans of triangles; what is drawn at all
//   precision      faces of tets in float or in double
//   visibility     the order of tets
//   compositing    dithering; whether the program or the blending unit rounds to codes; a tree
//   source         how a tet's segment of a ray is integrated, whether all that is visible has one
//                  colour, and the error, measured on trial rays
struct ProjectPlanner {
    const Scene& scene;
    const MeshFacts& facts;
    const Capabilities& capabilities;
    Omissions omissions;
    TableCache& tables;
    const ProjectSettings& settings = scene.project;
    double unit = world_unit(facts.diagonal);  // of the plan
    TransferFunction transfer_function = in_units(*scene.transfer_function, unit);
    ValueRange drawn = drawn_range(*scene.transfer_function, facts.range);  // of scalars
    ProjectPlan plan = {};

    Plan make() {
        plan.unit = unit;
        plan.target = *scene.target;
        plan.seed = scene.emulate.seed;
        plan.thickness = settings.thickness;
        plan.table_filtered = capabilities.exact_float_filter;
        plan.near_depth = near_share * facts.diagonal * plan.unit;
        plan.range = drawn;
        static_cast<LightPlan&>(plan) = plan_light(scene, facts.max_color, true);
        check_size();
        plan.interpolation = interpolation();
        plan.geometry = geometry();
        choose_what_is_drawn();
        plan.plain = choose_precision(plan.geometry == ProjectGeometry::triangles);
        plan.solve_rings =
            (is_right_order(settings.order) && !orders_slowly(settings.order, facts.overlap)) ||
            // `auto` takes `mpvo` for a convex mesh, for which it is right.
            (settings.order == ProjectOrder::mpvo && facts.convexity != Convexity::none);
        plan.visibility = choose_visibility();
        plan.overlaps = facts.overlap.pairs;
        plan.dither = choose_dither();
        if (scene.target == Target::emulated) plan.emulation = scene.emulate;
        if (plan.emulation || plan.dither == ProjectDither::after_blend) choose_blending();
        if (settings.tree) choose_tree();
        choose_source();
        // With a tree, transparent cell fragments are never drawn, even with --no-omit: leaves have
        // a fixed share of the cell fragments, so drawing more of them would make another picture.
        if (plan.source == SegmentSource::parts && settings.tree) plan.draw_transparent = false;
        plan.walk = omissions.leave_out(
            choose_walk(), "blending",
            "float32: each ray walks from tet to tet and composites in registers; tets are neither "
            "sorted nor drawn");
        plan.blocks = choose_blocks();
        set_error();
        Plan made;
        made.method = Method::project;
        made.project = std::move(plan);
        made.omitted = std::move(omissions.list);
        return made;
    }

    // Throws Error if the mesh is so small or large that products of four lengths, which decide the
    // order of tets, would leave the range of double.
    void check_size() const {
        constexpr double least = 1e-60, most = 1e60;
        if (facts.diagonal == 0 || (facts.diagonal >= least && facts.diagonal <= most)) return;
        fail("{}: the diagonal of the mesh is {}, expected {} to {} for method project",
             name_of_mesh(scene), facts.diagonal, least, most);
    }

    // Returns `linear` for Shirley's and Tuchman's triangles: their values have no single depth.
    Interpolation interpolation() const {
        return settings.coloring == Coloring::vertex ? Interpolation::linear
                                                     : settings.interpolation;
    }

    // Returns fans if values are interpolated between vertices, which silhouettes cannot do.
    ProjectGeometry geometry() const {
        const bool fan =
            settings.interpolation == Interpolation::linear || mixes_colors(settings.coloring);
        return settings.geometry.value_or(fan ? ProjectGeometry::triangles
                                              : ProjectGeometry::silhouette);
    }

    void choose_what_is_drawn() {
        plan.orthographic = facts.orthographic;  // the other geometry cannot draw such views
        if (plan.orthographic) {
            omissions.list.push_back(
                {"perspective",
                 "parallel rays: depth is linear in the picture, nothing is divided "
                 "per fragment, with --no-omit neither"});
        }
        const bool transparent = facts.transparent_tets == facts.tets;
        if (facts.clipped_away)
            omissions.list.push_back({"drawing", "the clip cuts the whole mesh away"});
        plan.nothing_visible =
            facts.clipped_away ||
            omissions.leave_out(transparent || !facts.in_front, "drawing",
                                transparent
                                    ? "the transfer function shows no value that the mesh has"
                                    : "the mesh lies behind the eye");
        const bool left_out =
            omissions.leave_out(facts.transparent_tets > 0, "transparent_tets",
                                fmt::format("{} of {} tets show nothing: they are not projected",
                                            facts.transparent_tets, facts.tets));
        // If a value is not finite, nothing can be drawn.
        plan.draw_transparent = !left_out && facts.non_finite == 0;
    }

    bool is_large() const { return facts.tets >= fewest_plain_tets; }

    // Tells whether the program composites codes. Every face is then found in double, as float32
    // may be off by 2e-3 of a segment (float_tolerance), and both engines show the same codes.
    bool composites_codes() const {
        const bool dithered =
            is_fixed_point(*scene.target) && settings.dither == ProjectDither::after_blend;
        return scene.target == Target::emulated || dithered;
    }

    bool choose_precision(bool fan) {
        if (composites_codes()) return fan;
        return omissions.leave_out(
                   !fan && is_large(), "double_precision",
                   fmt::format("{} tets: only where a face is seen nearly edge-on are faces "
                               "found in double",
                               facts.tets)) ||
               fan;
    }

    OrderMethod choose_visibility() {
        if (settings.order.is_given()) return method_of(*settings.order);
        if (omissions.leave_out(
                scene.target == Target::float32 && !scene.lighting && facts.single_color, "order",
                "one colour: OVER gives the same whatever comes first, to float32's rounding"))
            return OrderMethod::none;
        return facts.convexity == Convexity::none ? OrderMethod::exact : OrderMethod::mpvo;
    }

    ProjectDither choose_dither() {
        if (is_fixed_point(*scene.target) || settings.dither == ProjectDither::none)
            return settings.dither;
        omissions.list.push_back(
            {"dither", "tets are composited in float: there is nothing to dither"});
        return ProjectDither::none;
    }

    // Returns the bytes of a picture in a storage buffer, whose rows are padded (GlPixels).
    std::int64_t picture_bytes(std::int64_t pixel_bytes) const {
        constexpr std::int64_t alignment = 256;
        return (pixel_bytes * scene.width + alignment - 1) / alignment * alignment * scene.height;
    }

    // Compute shaders of OpenGL composite codes; they do not rasterise triangles.
    void choose_blending() {
        plan.blending = code_blending(capabilities);
        if (plan.blending != Blending::registers) return;
        const char* const key = plan.emulation ? "render.target" : "render.project.dither";
        const char* const value = plan.emulation ? name_of(plan.target) : name_of(plan.dither);
        if (plan.geometry == ProjectGeometry::triangles) {
            fail(
                "{}: {}: found \"{}\" with triangles (render.project.geometry, coloring or "
                "interpolation), whose fragments OpenGL's blending unit alone composites, expected "
                "silhouettes, or --context cpu",
                scene.file.string(), key, value);
        }
        const std::int64_t bytes = picture_bytes(plan.code_bits() > 8 ? 8 : 4);
        if (bytes > capabilities.max_storage_bytes) {
            fail(
                "{}: image: found {} x {} pixels, which take {} bytes as codes, expected at most "
                "{}: {}",
                scene.file.string(), scene.width, scene.height, bytes,
                capabilities.max_storage_bytes, capabilities.renderer);
        }
    }

    void choose_tree() {
        check_project_tree(scene, facts.single_color);
        plan.tree = given_tree(settings.tree)->factors;
        plan.scattered =
            settings.order.is_automatic() &&
            omissions.leave_out(
                true, "order",
                "one colour: leaves take tets from all over the mesh, so that every ray "
                "meets some of each leaf; codes are rounded in another order");
        if (plan.scattered) plan.visibility = OrderMethod::none;
    }

    void choose_source() {
        plan.single_color =
            omissions.leave_out(facts.single_color && !scene.lighting, "color",
                                "one colour in all that can be seen: only extinction is looked up");
        switch (settings.coloring) {
            case Coloring::vertex:
                plan.source = SegmentSource::vertices;
                break;
            case Coloring::attenuation:
                plan.source = SegmentSource::mean;
                break;
            case Coloring::preintegrated:
            case Coloring::analytic:
                choose_integral();
                break;
        }
    }

    // Rays walk if the picture is right in every pixel and has float32: then nothing is rounded
    // between two tets, so that it does not matter what composites them. A walk has places of 32
    // bits and scalars of 24, which must resolve the shortest edge and the scalars that are shown.
    // In software, lit walks take 1.4 times as long as the rasteriser (docs/journal.md).
    // Open faces that cross the eye's plane would be listed for all pixels, so the rasteriser draws
    // meshes around the eye.
    bool choose_walk() const {
        constexpr double shortest = 0x1p-22;      // of the diagonal: 2^9 steps of places
        constexpr std::size_t most_points = 200;  // loops of software hold few searches in more
        return picture_bytes(16) <= capabilities.max_storage_bytes &&
               std::max(facts.tets, facts.points) <= capabilities.max_buffer_texels &&
               !(capabilities.software && scene.lighting) && plan.target == Target::float32 &&
               plan.geometry == ProjectGeometry::silhouette && plan.tree.empty() &&
               plan.thickness == Thickness::exact && !plan.nothing_visible &&
               (plan.solve_rings || plan.single_color) && facts.overlap.none() &&
               facts.shortest_edge > shortest * facts.diagonal && !plan.windowed &&
               (facts.orthographic || facts.box_in_front) &&
               (!capabilities.software || scene.transfer_function->knots().size() <= most_points) &&
               !has_narrow_pieces(*scene.transfer_function, drawn);
    }

    // Tells whether tables are storage blocks: if that is asked for and the largest of a walk fits,
    // which has 16 bytes for each tet or point.
    bool choose_blocks() const {
        return capabilities.rays.blocks && (!plan.walk || 16 * std::max(facts.tets, facts.points) <=
                                                              capabilities.max_storage_bytes);
    }

    // Returns the error, or none for pictures that are wrong on purpose; for triangles, whose
    // corners lie on a rasteriser's grid; and for overlapping tets that are not ordered by entry.
    ErrorFigure picture_error() const {
        if (plan.nothing_visible) return {ErrorKind::derived, 0, 0};
        const bool integrated =
            plan.source != SegmentSource::mean && plan.source != SegmentSource::vertices;
        const bool straight =
            plan.geometry == ProjectGeometry::silhouette &&
            (plan.orthographic || plan.interpolation == Interpolation::perspective) &&
            plan.thickness == Thickness::exact;
        const bool sorted = plan.single_color ||
                            (plan.solve_rings && orders_overlaps(settings.order, facts.overlap));
        const bool stored = plan.target == Target::float32 && plan.tree.empty();
        if (!integrated || !straight || !sorted || !stored) return {};
        const MeshFacts::TrialError& found = plan.trial_error;
        // A picture is linear in its colours.
        const double brightest = std::max(largest_drawn_color(scene, facts.max_color), 1.0);
        const double value = brightest * (float_error + hidden_by_near_plane()) +
                             margin() * found.segments + found.places + plan.light_error;
        if (value > most_figure) return {};
        return {ErrorKind::sampled, value, found.rays};
    }

    double margin() const {
        if (plan.source != SegmentSource::table) return sampling_margin;
        return std::max(sampling_margin, std::pow(facts.pixels_a_trial_ray, sampling_root));
    }

    // Sets the picture's error. It includes a bound on rays along surfaces if max_error has room
    // for it. Otherwise it is unknown, and the error of all other rays is a remark.
    void set_error() {
        plan.error = picture_error();
        const double brightest = std::max(largest_drawn_color(scene, facts.max_color), 1.0);
        const double surface = 255 * brightest * facts.surface_error;
        if (plan.error.kind != ErrorKind::sampled || !(surface > 0)) return;
        if (plan.error.value + surface <= scene.max_error) {
            plan.error.value += surface;
        } else {
            plan.error_of_others = std::exchange(plan.error, {});
        }
    }

    // Returns a bound, in 1/255, on what the near plane hides of what has colours up to 1: rays
    // begin there and not at the eye, which trial rays do not show. A ray without a piece of depth
    // x at its front is off by at most the opacity of x.
    double hidden_by_near_plane() const {
        if (facts.box_in_front) return 0;
        const View view(*scene.camera, scene.width, scene.height);
        const double longest = facts.orthographic ? 1
                                                  : std::hypot(1, .5 * view.width * view.pixel,
                                                               .5 * view.height * view.pixel);
        return -255 * std::expm1(-facts.max_extinction * near_share * facts.diagonal * longest);
    }

    void choose_integral() {
        if (omissions.leave_out(facts.constant && facts.non_finite == 0 && !scene.lighting,
                                "scalars",
                                "the transfer function is constant over the mesh: opacity has a "
                                "closed form of the length alone")) {
            plan.source = SegmentSource::constant;
            plan.trial_error = error_of(exact_integral());
        } else if (settings.coloring == Coloring::analytic) {
            take_window();
            plan.source = SegmentSource::analytic;
            plan.trial_error = error_of(exact_integral());
        } else if (plan.nothing_visible) {
            return;
        } else if (settings.table.is_given()) {
            take_window();
            try_table(request_of(*settings.table));
        } else {
            choose_table();
        }
    }

    TableRequest request_of(const TableSettings& asked) const {
        return {.lo = plan.range.lo,
                .hi = plan.range.hi,
                .max_length = facts.longest_edge * plan.unit,
                .scalar_nodes = asked.scalar,
                .length_layers = asked.length,
                .colored = !plan.single_color,
                .kind = TableKind::uniform,
                .mapping = asked.mapping,
                .store = asked.store,
                .format = asked.format,
                .construction = asked.construction};
    }

    // Normalises scalars to the window of visible ones if that is far narrower than the range of
    // the data (docs/precision.md, "Exact segments").
    void take_window() {
        plan.windowed = is_far_narrower(facts.window, drawn);
        if (plan.windowed) plan.range = facts.window;
    }

    // Returns the integral of a segment whose length is in the plan's units.
    using Lookup = std::function<SegmentIntegral(const MeshFacts::Segment&)>;

    Lookup exact_integral() const {
        return [this](const MeshFacts::Segment& segment) {
            return integrate_segment(transfer_function, segment.front, segment.back,
                                     segment.length);
        };
    }

    // Returns the errors on the trial rays, in 1/255: the largest difference in colour or opacity
    // between a lookup with rounded scalars and the exact integral, and the additional difference
    // if faces are slightly displaced. Without trial rays, returns the errors found last.
    MeshFacts::TrialError error_of(const Lookup& lookup) const {
        if (facts.trial_rays.empty()) return facts.last_error;
        std::vector<RayError> errors(facts.trial_rays.size());
        parallel_for(static_cast<std::int64_t>(errors.size()), 8, [&](std::int64_t index) {
            const auto ray = static_cast<std::size_t>(index);
            errors[ray] = error_of_ray(facts.trial_rays[ray], lookup);
        });
        MeshFacts::TrialError largest{0, 0, std::ssize(errors)};
        double both = 0;
        for (const RayError& error : errors) {
            largest.segments = std::max(largest.segments, 255 * error.segments);
            both = std::max(both, 255 * error.both);
        }
        largest.places = std::max(both - largest.segments, 0.0);
        return largest;
    }

    // Errors as shares of full scale: of the lookup alone, and of lookup and displaced faces.
    struct RayError {
        double segments = 0, both = 0;
    };
    RayError error_of_ray(const std::vector<MeshFacts::Segment>& segments,
                          const Lookup& lookup) const {
        const double rounding = plan.source == SegmentSource::parts
                                    ? 0
                                    : scalar_rounding * (plan.range.hi - plan.range.lo);
        glm::dvec4 exact(0), moved(0);
        std::array<glm::dvec4, 2> found{glm::dvec4(0), glm::dvec4(0)};  // rounded down and up
        double sign = 1;
        for (std::size_t i = 0; i < segments.size(); ++i) {
            MeshFacts::Segment segment = segments[i];
            segment.length *= plan.unit;
            append(exact, integrate_segment(transfer_function, segment.front, segment.back,
                                            segment.length));
            for (std::size_t side = 0; side < found.size(); ++side) {
                for_each_piece_of_window(
                    rounded(segment, side == 0 ? -rounding : rounding), plan.range,
                    [&](const MeshFacts::Segment& piece) { append(found[side], lookup(piece)); });
            }
            // A face within the mesh takes length from one segment and gives it to the next. The
            // first and the last face of a ray move outwards.
            if (i + 1 == segments.size()) sign = 1;
            const double change = sign * 2 * placing_share * segment.edge * plan.unit;
            append(moved, integrate_segment(transfer_function, segment.front, segment.back,
                                            std::max(segment.length + change, 0.0)));
            sign = -sign;
        }
        const double of_lookup =
            std::max(largest_of(exact - found[0]), largest_of(exact - found[1]));
        return {of_lookup, of_lookup + largest_of(exact - moved)};
    }

    // Returns the segment with `rounding` added to its scalars. A segment of constant scalar is not
    // changed: the scalar and a step beside it round alike, so it stays on its side of the step.
    static MeshFacts::Segment rounded(MeshFacts::Segment segment, double rounding) {
        if (segment.front == segment.back) return segment;
        segment.front += rounding;
        segment.back += rounding;
        return segment;
    }

    static double largest_of(const glm::dvec4& v) {
        return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
    }

    // Composites a segment behind the sum of those in front of it (associated colour, opacity).
    static void append(glm::dvec4& sum, const SegmentIntegral& segment) {
        sum += (1 - sum.a) * glm::dvec4(segment.color, segment.alpha);
    }

    // Gets the requested table and measures its error on the trial rays.
    void try_table(const TableRequest& request) {
        plan.table.request = request;
        plan.table.built = tables.get(transfer_function, request);
        plan.trial_error =
            error_of([&table = *plan.table.built](const MeshFacts::Segment& segment) {
                return table.lookup(segment.front, segment.back, segment.length);
            });
    }

    // Cuts tets at the transfer function's points if that makes few cell fragments, or if pieces
    // are narrow. Otherwise takes a table with nodes on these points if its error on trial rays is
    // small. Otherwise integrates analytically, which is slower and right for every scene.
    void choose_table() {
        const bool whole = plan.geometry == ProjectGeometry::triangles;
        take_window();
        const bool few =
            facts.parts <= most_cell_fragments_a_tet * (facts.tets - facts.transparent_tets);
        const bool narrow = has_narrow_pieces(*scene.transfer_function, drawn);
        const bool cut = plan.windowed ? few && facts.far_tets == 0 : few || narrow;
        if (!whole && cut) {
            plan.windowed = false;
            plan.range = drawn;
            plan.source = SegmentSource::parts;
            plan.trial_error = error_of(plan.single_color ? exact_integral() : integral_of_parts());
        } else if ((plan.plain || (composites_codes() && is_large())) && !scene.lighting &&
                   try_cut_table()) {
            plan.source = SegmentSource::cut_table;
        } else {
            plan.source = SegmentSource::analytic;
            plan.trial_error = error_of(exact_integral());
        }
    }

    // Tries a table whose nodes lie on the transfer function's points; false if its error is too
    // large. (Equally spaced nodes err by several codes in regions whose value is next to a point.)
    bool try_cut_table() {
        if (scene.transfer_function->knots().size() > most_table_points) return false;
        const double depth = facts.max_extinction * facts.longest_edge;
        const int layers = static_cast<int>(std::clamp(std::ceil(depth) + 1, 2.0, 9.0));
        try_table({.lo = plan.range.lo,
                   .hi = plan.range.hi,
                   .max_length = facts.longest_edge * plan.unit,
                   .scalar_nodes = 256,
                   .length_layers = plan.single_color ? 1 : layers,
                   .colored = !plan.single_color});
        const double most = std::min(most_segment_error, scene.max_error / 2) / sampling_margin;
        if (plan.trial_error.segments <= most) return true;
        plan.table.built.reset();
        return false;
    }

    // Returns the lookup that integrates pieces of tets as drawn
    // (projection/fragment_segment-inl.h).
    Lookup integral_of_parts() const {
        return [this, &weights = FrontWeightTable::get()](const MeshFacts::Segment& segment) {
            SegmentIntegral sum;
            for_each_linear_piece(
                transfer_function.knots(), segment.front, segment.back,
                [&](const LinearPiece& piece) {
                    const double share =
                        segment.front == segment.back
                            ? 1
                            : (piece.to - piece.from) / (segment.back - segment.front);
                    const double p = share * segment.length * piece.at_from.extinction,
                                 q = share * segment.length * piece.at_to.extinction;
                    const double alpha = opacity_from_depth(p / 2 + q / 2);
                    const bool thin = plan.plain && p / 2 + q / 2 <= thin_depth;
                    const double weight = thin ? thin_front_weight(p, q) : weights.lookup(p, q);
                    sum.color +=
                        (1 - sum.alpha) * (alpha * piece.at_to.color +
                                           weight * (piece.at_from.color - piece.at_to.color));
                    sum.alpha += (1 - sum.alpha) * alpha;
                });
            return sum;
        };
    }
};

}  // namespace

const char* name_of(SegmentSource source) {
    return word_of(source,
                   {"constant", "table", "parts", "cut_table", "analytic", "mean", "vertices"});
}

Plan plan_projection(const Scene& scene, const MeshFacts& facts, const Capabilities& capabilities,
                     const OmissionSwitch& omissions, TableCache& tables) {
    return ProjectPlanner{scene, facts, capabilities, {omissions}, tables}.make();
}

}  // namespace lamina
