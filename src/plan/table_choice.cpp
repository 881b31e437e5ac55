// SPDX-License-Identifier: Apache-2.0
#include "plan/choices.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "optics/pieces.h"
#include "optics/ray_lights.h"
#include "optics/segment_integral.h"
#include "scene/camera.h"

namespace lamina {
namespace {

// Largest numbers of segments that are tried on one ray, and on all rays together. If a ray has
// more segments, equally spaced ones stand for all. If it has fewer, more rays are tried.
constexpr int most_tried = 64, most_tried_of_all_rays = 1 << 14;

// Largest number of linear pieces that are tried one by one, from all over the range.
constexpr std::size_t most_pieces_tried = 64;

// Limits of a coloured table: the linear pieces that are integrated to build it (4e6 take some .2 s
// on two cores) and its bytes. They are low because several tables are built to choose one.
constexpr double most_table_work = 4e6, most_table_bytes = 128 << 20;
constexpr double most_nodes = 2048;  // limit of a texture

// Largest numbers of layers (segment lengths): in a table's first size, and if that errs too much.
// Linear interpolation between layers at most an optical depth of 1 apart errs by .0025 or less.
// If layers are farther apart, most segments are nearly opaque and change little with length.
constexpr double usual_length_layers = 9, most_length_layers = 33;

// Factor on the number of nodes for the next table that is tried.
constexpr int finer_nodes = 4;

// A segment of a ray on which the table is tried: the scalars at its ends, and its length.
struct Segment {
    double front = 0, back = 0, length = 0;
    double transmittance = 1;  // of everything in front of the segment
};

// Cuts a ray at the boundaries of slabs, and at the box.
struct RayCutter {
    const ScalarRays::Ray& ray;
    double first, thickness;  // of the slabs
    ValueRange range;

    // Returns the segment in slab i; its length is <= 0 outside of the box. Its ends are moved as
    // renderers move them: to the mean of the parabola through both ends and the middle
    // (docs/precision.md).
    Segment segment(int i) const {
        const double from = std::max(first + i * thickness, ray.near);
        const double to = std::min(first + (i + 1) * thickness, ray.far);
        if (!(from < to)) return {};
        const double front = at(ray.scalars, from), back = at(ray.scalars, to);
        const double bend = (2 * at(ray.scalars, (from + to) / 2) - front - back) / 3;
        return {std::clamp(front + bend, range.lo, range.hi),
                std::clamp(back + bend, range.lo, range.hi), (to - from) * ray.length_per_depth,
                std::exp(-at(ray.optical_depths, from))};
    }

    double at(const std::vector<float>& values, double depth) const {
        const auto steps = static_cast<double>(values.size() - 1);
        const double place =
            std::clamp((depth - ray.near) / (ray.far - ray.near), 0.0, 1.0) * steps;
        const auto before = std::min(static_cast<std::size_t>(place), values.size() - 2);
        const double weight = place - static_cast<double>(before);
        if (weight == 0) return values[before];
        if (weight == 1) return values[before + 1];
        return (1 - weight) * values[before] + weight * values[before + 1];
    }
};

double largest(const glm::dvec3& error) {
    return std::max({std::abs(error.r), std::abs(error.g), std::abs(error.b)});
}

// Bounds on what light adds to a colour component: `change` times the component, and `highlight`.
struct MostLight {
    double change = 0, highlight = 0;
};

MostLight most_light(const Scene& scene) {
    if (!scene.lighting) return {};
    const RayLights lights(**scene.lighting, glm::dvec3(0, 0, 1));
    const double highlight = lights.largest_effect(0);
    return {lights.largest_effect(1) - highlight, highlight};
}

// Sums the errors of a ray's segments, each weighted by the transmittance in front of it: errors of
// the unlit colour, and errors of what light adds if it acts only at the fronts of segments.
struct ErrorSum {
    MostLight light;
    glm::dvec3 unlit{0}, front{0};

    void add(double weight, const LitIntegral& found, const LitIntegral& right) {
        unlit += weight * (found.whole.color - right.whole.color);
        front += weight * (light.change * (found.front.color - right.front.color) +
                           light.highlight * (found.front.alpha - right.front.alpha));
    }
    // Returns the largest error of four cases: without light, with light at all fronts, at all
    // backs, and everywhere. Opacity is exact.
    double largest_error() const {
        const glm::dvec3 lit = light.change * unlit;
        return std::max({largest(unlit), largest(unlit + front), largest(unlit + lit - front),
                         largest(unlit + lit)});
    }
};

// Returns segments without length, centred at four places in linear pieces, of three widths (spans
// of scalars) up to `widest`. Rays alone would meet few narrow pieces.
std::vector<Segment> segments_of_pieces(const TransferFunction& transfer_function,
                                        const ValueRange& range, double widest) {
    std::vector<LinearPiece> pieces;
    for_each_linear_piece(transfer_function.knots(), range.lo, range.hi,
                          [&](const LinearPiece& piece) { pieces.push_back(piece); });
    std::vector<Segment> segments;
    const std::size_t step = pieces.size() / most_pieces_tried + 1;
    for (std::size_t i = 0; i < pieces.size(); i += step) {
        const LinearPiece& piece = pieces[i];
        for (const double place : {.03, .3, .7, .97}) {
            const double middle = piece.from + place * (piece.to - piece.from);
            for (const double width :
                 {std::min(widest, .1 * (piece.to - piece.from)), .1 * widest, widest}) {
                const double lower = std::max(middle - width / 2, range.lo);
                const double upper = std::min(middle + width / 2, range.hi);
                segments.push_back({lower, upper});
                segments.push_back({upper, lower});
            }
        }
    }
    return segments;
}

// Returns fewer layers if those wanted would take too long or too much memory.
int affordable_layers(const TableRequest& table, double knots, double wanted) {
    // Largest number of nodes that the table can have (preintegration/preintegration_table.h).
    const double nodes = 1.5 * table.scalar_nodes + 3 * (knots + 1);
    // Linear pieces to integrate: one for nodes in one piece; for two points, all between them.
    const double work = nodes * nodes / (knots + 1) + knots * knots * knots / 3;
    const double numbers = table.lit ? 7 : 3;  // floats of an entry in each layer
    const double bytes = nodes * nodes * numbers * sizeof(float);
    return static_cast<int>(std::max(
        1.0, std::floor(std::min({wanted, most_table_work / work, most_table_bytes / bytes}))));
}

}  // namespace

void get_table(const Scene& scene, const Facts& facts, TablePlan& table, TableCache& tables) {
    const double unit = world_unit(box_diagonal(facts.grid));
    table.built = tables.get(in_units(*scene.transfer_function, unit), table.request);
}

double table_error(const Scene& scene, const Facts& facts, int slabs, const TablePlan& plan) {
    const double unit = world_unit(box_diagonal(facts.grid));
    const TransferFunction transfer_function = in_units(*scene.transfer_function, unit);
    const MostLight light = most_light(scene);
    const auto looked_up = [&table = *plan.knot_table()](const Segment& segment) {
        return table.lookup_lit(segment.front, segment.back, segment.length);
    };
    const auto integrated = [&](const Segment& segment) {
        const double front = segment.front, back = segment.back, length = segment.length;
        if (plan.request.lit) return integrate_lit_segment(transfer_function, front, back, length);
        return LitIntegral{integrate_segment(transfer_function, front, back, length), {}};
    };
    const std::vector<ScalarRays::Ray>& rays = facts.scalar_rays.rays;
    const int stride = (slabs + most_tried - 1) / most_tried;
    const auto tried_rays =
        static_cast<std::size_t>(most_tried_of_all_rays / std::min(slabs, most_tried));
    const std::size_t ray_stride = (rays.size() + tried_rays - 1) / tried_rays;
    struct Found {
        double error = 0, widest = 0;  // widest: largest difference of scalars in a segment
    };
    std::vector<Found> found(rays.empty() ? 0 : (rays.size() - 1) / ray_stride + 1);
    parallel_for(static_cast<std::int64_t>(found.size()), 8, [&](std::int64_t number) {
        Found& of_ray = found[static_cast<std::size_t>(number)];
        const ScalarRays::Ray& ray = rays[ray_stride * static_cast<std::size_t>(number)];
        const RayCutter cutter{ray, facts.near_depth, (facts.far_depth - facts.near_depth) / slabs,
                               facts.range};
        ErrorSum error{light};
        double transmittance = 1;  // of the segments before, as they are drawn
        for (int i = stride / 2; i < slabs; i += stride) {
            Segment segment = cutter.segment(i);
            segment.length *= unit;
            if (!(segment.length > 0) || !std::isfinite(segment.front + segment.back)) continue;
            const LitIntegral integral = integrated(segment);
            if (stride > 1) transmittance = segment.transmittance;
            error.add(stride * transmittance, looked_up(segment), integral);
            transmittance *= 1 - integral.whole.alpha;
            of_ray.widest = std::max(of_ray.widest, std::abs(segment.back - segment.front));
        }
        of_ray.error = error.largest_error();
    });
    Found all;
    for (const Found& of_ray : found) {
        all.error = std::max(all.error, of_ray.error);
        all.widest = std::max(all.widest, of_ray.widest);
    }
    std::vector<Segment> single = segments_of_pieces(transfer_function, facts.range, all.widest);
    std::vector<double> errors(single.size());
    parallel_for(static_cast<std::int64_t>(single.size()), 64, [&](std::int64_t number) {
        const auto i = static_cast<std::size_t>(number);
        single[i].length = plan.request.max_length;
        ErrorSum error{light};
        error.add(1, looked_up(single[i]), integrated(single[i]));
        errors[i] = error.largest_error();
    });
    return 255 * std::max(all.error, errors.empty() ? 0 : std::ranges::max(errors));
}

void refine_table(const Scene& scene, const Facts& facts, int slabs, double depth, TablePlan& table,
                  TableCache& tables) {
    const auto knots = static_cast<double>(facts.knots);
    const double steps = std::ceil(depth);  // each of depth 1 or less
    TablePlan tried = table;
    double wanted = std::min(steps + 1, usual_length_layers);
    const auto try_it = [&] {
        tried.request.length_layers = affordable_layers(tried.request, knots, wanted);
        get_table(scene, facts, tried, tables);
        tried.error = table_error(scene, facts, slabs, tried);
    };
    const auto keep_better = [&] {
        try_it();
        if (tried.error < table.error) table = tried;
    };
    try_it();
    table = tried;
    const double goal = table_share * scene.max_error;
    if (table.error > goal) {
        const auto room = static_cast<int>((most_nodes - 3 * (knots + 1)) / 1.5);
        int& nodes = tried.request.scalar_nodes;
        nodes = std::max(nodes, std::min(finer_nodes * nodes, room));
        keep_better();
    }
    if (table.error > goal && steps > 0) {
        wanted = std::min(4 * steps + 1, most_length_layers);
        keep_better();
    }
}

void take_table(const Scene& scene, const Facts& facts, int slabs, double longest, double unit,
                TablePlan& table, TableCache& tables) {
    const SliceTableSettings& asked = *scene.slice.table;
    TableRequest& request = table.request;
    request.scalar_nodes = asked.scalars;
    request.length_layers = asked.lengths;
    double most = asked.max_length;
    const bool short_alone = asked.lengths == 1 && facts.max_extinction * longest >= short_depth;
    if (longest > most || short_alone) {
        most = std::max(longest, box_diagonal(facts.grid) / slabs * facts.max_length_per_depth);
        const double as_close = asked.lengths > 1 && asked.max_length > 0
                                    ? (asked.lengths - 1) * most / asked.max_length
                                    : 0;
        const double steps = std::max(as_close, facts.max_extinction * most);
        const bool none = asked.lengths == 1 && facts.max_extinction * most < short_depth;
        request.length_layers =
            none ? 1 : static_cast<int>(std::min(std::ceil(steps) + 1, most_length_layers));
    }
    request.max_length = most * unit;
    if (facts.scalar_rays.rays.empty()) return;
    get_table(scene, facts, table, tables);
    table.error = table_error(scene, facts, slabs, table);
}

}  // namespace lamina
