// SPDX-License-Identifier: Apache-2.0
#include "volume/examples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "base/client.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/coded_image.h"
#include "volume/generate.h"
#include "volume/gradient_noise.h"
#include "volume/labels.h"

// Places are in mm: x to the left, y to the back, z upwards, 0 in the middle of the head, between
// the ears. The numbers only shape the head; nothing measures with them.
namespace lamina {
namespace {

// Shapes as signed distances, negative inside (Quilez, "Distance functions", iquilezles.org). They
// use only operations that IEEE 754 rounds alike on every machine.

// Approximate, exact at the surface.
double distance_to_ellipsoid(const glm::dvec3& p, const glm::dvec3& center,
                             const glm::dvec3& radii) {
    const glm::dvec3 scaled = (p - center) / radii;
    const double slope = glm::length(scaled / radii);
    const double length = glm::length(scaled);
    if (slope == 0) return -std::min({radii.x, radii.y, radii.z});
    return length * (length - 1) / slope;
}

// A rod with round ends, whose radius changes evenly from one end to the other.
double distance_to_rod(const glm::dvec3& p, const glm::dvec3& begin, const glm::dvec3& end,
                       double begin_radius, double end_radius) {
    const glm::dvec3 along = end - begin;
    const double t = std::clamp(glm::dot(p - begin, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(p - begin - t * along) - (begin_radius + t * (end_radius - begin_radius));
}

// A box around the origin with edges rounded by `radius`, which `half` includes.
double distance_to_box(const glm::dvec3& p, const glm::dvec3& half, double radius) {
    const glm::dvec3 beyond = glm::abs(p) - half + radius;
    return glm::length(glm::max(beyond, glm::dvec3(0))) +
           std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0) - radius;
}

// Union of two shapes with a fillet of about the size `blend`.
double smooth_union(double a, double b, double blend) {
    const double near = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - near * near * blend / 4;
}

// Takes shape `b` away from `a` and rounds the edge.
double smooth_difference(double a, double b, double blend) {
    return -smooth_union(-a, b, blend);
}

using glm::dvec3;

constexpr double voxel_edge = 1.5;  // mm
constexpr std::array<std::int64_t, 3> head_size{128, 160, 160};
const dvec3 first_sample{-95.25, -124.0, -120.0};  // mm
constexpr double scanner_blur = 2.2;               // mm, over which a scanner blends two tissues
constexpr double scanner_noise = 9;                // HU, deviation

enum Tissue : std::uint8_t {
    nothing,
    skull,
    jaw,
    teeth,
    spine,
    cerebrum,
    cerebellum,
    brain_stem,
    ventricles,
    eyes,
    soft_tissue
};

// The value of a tissue, in HU.
constexpr double air_hu = -1000, fat_hu = -95, muscle_hu = 52, skin_hu = 25, fluid_hu = 6;
constexpr double white_matter_hu = 27, grey_matter_hu = 39, bone_hu = 1150, marrow_hu = 480;
constexpr double enamel_hu = 2350, lens_hu = 95, eye_hu = 14;

struct Voxel {
    double hu = air_hu;
    Tissue tissue = nothing;

    // Covers what is there by a shape at a distance.
    void paint(double distance, double value, Tissue by) {
        const double share = std::clamp(0.5 - distance / scanner_blur, 0.0, 1.0);
        hu += share * (value - hu);
        if (distance < 0) tissue = by;
    }
};

// Mirrors left and right: all but noise is symmetric.
dvec3 one_side(const dvec3& p) {
    return {std::abs(p.x), p.y, p.z};
}

// The features of a face, added to the skin at distance `d`.
double with_face(double d, const dvec3& p, const dvec3& q) {
    const auto add = [&](double other, double blend) { d = smooth_union(d, other, blend); };
    const auto cut = [&](double other, double blend) { d = smooth_difference(d, other, blend); };
    add(distance_to_ellipsoid(q, {35, -64, -16}, {22, 21, 16}), 18);  // cheek
    add(distance_to_rod(q, {4, -84, 21}, {36, -73, 20}, 7, 6), 12);   // brow
    cut(distance_to_ellipsoid(q, {33, -92, 3}, {17, 15, 11}), 12);    // eye socket
    add(distance_to_ellipsoid(q, {32, -73, 4}, {15, 13, 11}), 5);     // lids
    cut(distance_to_ellipsoid(q, {32, -87, 3}, {11, 4, 1.2}), 1.5);
    add(distance_to_rod(p, {0, -84, 12}, {0, -107, -26}, 5, 7.5), 10);  // nose
    add(distance_to_ellipsoid(q, {9, -97, -28}, {7, 9, 7}), 6);
    cut(distance_to_ellipsoid(q, {6, -100, -36}, {3.5, 5.5, 6}), 2);
    add(distance_to_rod(q, {0, -89, -50}, {15, -82, -52}, 5.5, 3.5), 6);  // lips
    add(distance_to_rod(q, {0, -87, -60}, {13, -81, -59}, 6, 4), 6);
    cut(distance_to_rod(q, {0, -97, -55.5}, {24, -82, -56}, 2.2, 1.5), 3);
    return d;
}

// Shapes are left out farther away than they blend.
double distance_to_skin(const dvec3& p) {
    const dvec3 q = one_side(p);
    double d = distance_to_ellipsoid(p, {0, 10, 33}, {77, 97, 80});
    const auto add = [&](double other, double blend) { d = smooth_union(d, other, blend); };
    if (p.z < 65) {
        add(distance_to_ellipsoid(p, {0, -32, -24}, {56, 58, 62}), 25);
        add(distance_to_ellipsoid(q, {38, -18, -18}, {33, 46, 36}), 18);  // temple
    }
    if (p.z < -30) {
        add(distance_to_ellipsoid(p, {0, -66, -86}, {25, 27, 18}), 30);      // chin
        add(distance_to_rod(q, {45, -4, -62}, {22, -62, -84}, 17, 16), 18);  // jaw
    }
    if (p.z < 20) add(distance_to_rod(p, {0, 28, -60}, {0, 36, -160}, 50, 55), 30);  // neck
    if (p.y < -35 && p.z < 45 && p.z > -80) d = with_face(d, p, q);
    if (q.x > 60 && std::abs(p.z) < 40) {
        const double ear = distance_to_ellipsoid(q, {80, 20, 0}, {9, 19, 31});
        add(smooth_difference(ear, distance_to_ellipsoid(q, {87, 15, 2}, {6, 11, 20}), 4), 6);
    }
    return d;
}

// The curve in which teeth stand: an ellipse in x and y whose middle lies at y = -40.
struct Arch {
    double half_width, depth;

    // Returns the approximate distance outwards from the curve, which goes on straight backwards.
    double outwards(const dvec3& q) const {
        if (q.y > -40) return q.x - half_width;
        const dvec3 p{q.x / half_width, (q.y + 40) / depth, 0};
        return (glm::length(p) - 1) * 0.5 * (half_width + depth);
    }
};

constexpr Arch upper_arch{29, 39}, lower_arch{27.5, 37};

// The teeth of one side, from the front. `turn`: angle along the arch, in turns.
struct Tooth {
    double turn, width, thickness, height;  // mm
};

constexpr Tooth tooth_row[] = {{0.021, 8.4, 6.0, 11.5}, {0.062, 7.2, 6.0, 10.5},
                               {0.102, 7.6, 7.4, 11.5}, {0.141, 7.0, 8.0, 9.5},
                               {0.178, 7.0, 8.4, 9.0},  {0.220, 9.6, 10.0, 8.5},
                               {0.268, 9.4, 10.0, 8.0}};

struct PlacedTooth {
    dvec3 center, along, outwards;
    dvec3 half;
};

std::vector<PlacedTooth> placed_teeth(const Arch& arch, double gum, double direction) {
    std::vector<PlacedTooth> teeth;
    for (const Tooth& tooth : tooth_row) {
        const double c = portable_cos_turns(tooth.turn);
        const double s = portable_cos_turns(tooth.turn - 0.25);
        const dvec3 along = glm::normalize(dvec3{arch.half_width * c, arch.depth * s, 0});
        teeth.push_back(
            {{arch.half_width * s, -40 - arch.depth * c, gum + direction * tooth.height / 2},
             along,
             {along.y, -along.x, 0},
             {tooth.width / 2 - 0.45, tooth.thickness / 2, tooth.height / 2}});
    }
    return teeth;
}

double distance_to_teeth(const std::vector<PlacedTooth>& teeth, const dvec3& q) {
    double d = 1e9;
    for (const PlacedTooth& tooth : teeth) {
        const dvec3 from = q - tooth.center;
        const dvec3 local{glm::dot(from, tooth.along), glm::dot(from, tooth.outwards), from.z};
        d = std::min(d, distance_to_box(local, tooth.half, 2));
    }
    return d;
}

double distance_to_brain_case(const dvec3& p) {
    return distance_to_ellipsoid(p, {0, 10, 33}, {64, 84, 67});
}

double distance_to_skull(const dvec3& p) {
    const dvec3 q = one_side(p);
    double d = distance_to_ellipsoid(p, {0, 10, 33}, {70, 90, 73});
    const auto add = [&](double other, double blend) { d = smooth_union(d, other, blend); };
    const auto cut = [&](double other, double blend) { d = smooth_difference(d, other, blend); };
    if (p.z < 40 && p.y < 25) {
        add(distance_to_ellipsoid(p, {0, -46, -22}, {33, 34, 26}), 10);      // upper jaw
        add(distance_to_rod(q, {0, -78, 20}, {36, -69, 22}, 6, 5), 12);      // brow
        add(distance_to_rod(q, {46, -60, 16}, {48, -57, -8}, 6, 6.5), 9);    // rim
        add(distance_to_rod(q, {25, -72, -17}, {49, -56, -14}, 6.5, 8), 8);  // cheekbone
        add(distance_to_rod(q, {50, -54, -14}, {64, -22, -13}, 6, 3.5), 6);  // its arch
        add(distance_to_rod(q, {64, -22, -13}, {64, 6, -8}, 3.5, 5), 5);
        add(distance_to_rod(p, {0, -82, 14}, {0, -93, -5}, 5, 4), 5);  // nose
        const double outwards = upper_arch.outwards(q);                // gums
        add(distance_to_box({outwards, std::max(q.y + 32, 0.0), q.z + 41}, {6, 6, 9}, 4), 7);
        cut(distance_to_rod(q, {34, -92, 2}, {22, -72, 0}, 17, 9), 4);  // eye socket
        cut(distance_to_ellipsoid(q, {5, -88, -18}, {8, 26, 13}), 5);   // nasal cavity
        cut(distance_to_rod(p, {0, -92, -8}, {0, -84, -6}, 6, 5), 4);
        cut(distance_to_ellipsoid(q, {28, -50, -22}, {10, 14, 12}), 3);  // sinuses
    }
    if (p.z < 10) {
        add(distance_to_rod(q, {52, 24, -20}, {49, 22, -37}, 8, 4.5), 8);  // behind the ear
        cut(distance_to_ellipsoid(p, {0, 34, -40}, {15, 18, 16}), 4);      // spinal canal
        cut(distance_to_rod(q, {40, 14, -10}, {90, 16, -8}, 3, 4), 2);     // ear canal
    }
    return d;
}

double distance_to_jaw(const dvec3& q) {
    const double outwards = lower_arch.outwards(q);
    const double back = std::max(q.y + 24, 0.0);
    // The lower edge falls towards the chin.
    const double middle = -83 + 0.12 * (q.y + 40);
    double d = distance_to_box({outwards - 0.25 * back, back, q.z - middle}, {5.5, 10, 12}, 4);
    // The branch towards the ear: a flat rod, with a notch between its two ends.
    constexpr double flat = 2.2;
    const dvec3 wide{flat * (q.x - 0.14 * (q.z + 70)), q.y, q.z};
    const double branch =
        distance_to_rod(wide, {flat * 42, -16, -76}, {flat * 42, -6, -36}, 13, 14);
    d = smooth_union(d, branch / 1.5, 6);
    d = smooth_difference(d, distance_to_ellipsoid(q, {48, -8, -20}, {14, 8, 12}), 4);
    d = smooth_union(d, distance_to_rod(q, {46, 4, -38}, {52, 9, -17}, 4.5, 5.5), 6);
    return smooth_union(d, distance_to_rod(q, {0, -80, -93}, {11, -77, -92}, 6, 4.5), 6);
}

// std::hypot rounds in its own way in every library.
double length_of(double x, double y) {
    return std::sqrt(x * x + y * y);
}

double distance_to_spine(const dvec3& q) {
    constexpr double step = 17.5;  // mm from one vertebra to the next
    const double top = -46;
    if (q.z > top) return q.z - top + 1;
    const double below = top - q.z;
    const double level = below - step * std::floor(below / step) - step / 2;  // 0: in the middle
    const dvec3 p{q.x, q.y - 32, level};
    const double around = length_of(p.x / 1.25, p.y) - 12;
    double d = std::max(around, std::abs(level) - 6.6);
    d = smooth_union(d, distance_to_rod(p, {8, 6, 0}, {26, 4, -2}, 5, 4), 4);
    d = smooth_union(d, distance_to_rod(p, {16, 12, 0}, {4, 27, -2}, 5, 4.5), 4);
    d = smooth_union(d, distance_to_rod(p, {0, 28, -2}, {0, 41, -6}, 4.5, 3.5), 4);
    return std::max(smooth_difference(d, length_of(p.x, p.y - 18) - 7.5, 2), -level - 8.3);
}

double distance_to_airways(const dvec3& p) {
    const dvec3 q = one_side(p);
    double d = distance_to_ellipsoid(q, {6.5, -50, -20}, {4.5, 34, 13});
    d = std::min(d, distance_to_rod(p, {0, -16, -22}, {0, -2, -64}, 8, 8));
    d = smooth_union(d, distance_to_rod(p, {0, -2, -64}, {0, 4, -130}, 8, 9), 6);
    d = std::min(d, distance_to_rod(q, {6, -100, -37}, {6, -80, -24}, 3, 4));       // nostrils
    d = std::min(d, distance_to_ellipsoid(q, {28, -50, -22}, {9, 13, 11}));         // sinuses
    return std::min(d, distance_to_rod(q, {48, 14, -10}, {95, 16, -8}, 2.5, 3.2));  // ear canal
}

// The noise of one row, for the texture of tissues.
struct Texture {
    std::vector<double> folds, grain;
};

class Head {
  public:
    Voxel at(const dvec3& p, double folds, double grain) const {
        Voxel voxel;
        const double skin = distance_to_skin(p);
        if (skin > scanner_blur) return voxel;
        const dvec3 q = one_side(p);
        paint_outside(voxel, skin, grain);
        const double brain_case = distance_to_brain_case(p);
        if (brain_case > -scanner_blur) paint_bones(voxel, p, q, grain);
        if (brain_case < scanner_blur) paint_brain(voxel, p, q, brain_case, folds);
        if (p.y < -30 && p.z > -25 && p.z < 35) paint_eye(voxel, q);
        if (brain_case > 0) voxel.paint(distance_to_airways(p), air_hu, nothing);
        const double share = std::clamp(0.5 - skin / scanner_blur, 0.0, 1.0);
        voxel.hu = air_hu + share * (voxel.hu - air_hu);
        if (skin > 0) voxel.tissue = nothing;
        return voxel;
    }

  private:
    static void paint_outside(Voxel& voxel, double skin, double grain) {
        voxel.paint(skin - scanner_blur, skin_hu, soft_tissue);
        voxel.paint(skin + 2.2, fat_hu + 8 * grain, soft_tissue);
        voxel.paint(skin + 6 + 2 * grain, muscle_hu + 14 * grain, soft_tissue);
    }

    void paint_bones(Voxel& voxel, const dvec3& p, const dvec3& q, double grain) const {
        const auto paint = [&](double distance, Tissue tissue) {
            // Marrow lies more than 2 mm below the surface.
            const double depth = smooth_step((-distance - 1.4) / 2);
            const double inner = marrow_hu + 260 * grain;
            voxel.paint(distance, bone_hu + depth * (inner - bone_hu), tissue);
        };
        if (p.z > -65) paint(distance_to_skull(p), skull);
        if (p.z < -10 && p.y < 20) paint(distance_to_jaw(q), jaw);
        if (p.z < -40 && p.y > 10 && q.x < 40) paint(distance_to_spine(q), spine);
        if (p.z < -40 && p.z > -80 && p.y < -25) {
            voxel.paint(distance_to_teeth(upper_, q), enamel_hu, teeth);
            voxel.paint(distance_to_teeth(lower_, q), enamel_hu, teeth);
        }
    }

    static void paint_brain(Voxel& voxel, const dvec3& p, const dvec3& q, double brain_case,
                            double folds) {
        const double surface = brain_case + 2.5;
        voxel.paint(brain_case, fluid_hu, ventricles);
        if (brain_case < 0) voxel.tissue = nothing;
        const double furrow = 3.2 * (1 - smooth_step(std::abs(folds) * 5)) *
                              smooth_step((surface + 16) / 8);  // deep near the surface
        const double fissure =
            1.3 - q.x + 0.08 * std::max(0.0, 34 - glm::length(p - dvec3{0, 10, 30}));
        const double tent = -12 - p.z - 0.25 * std::abs(p.y - 60);
        const double cerebrum_at = std::max({surface + furrow, fissure * 1.5, tent});
        voxel.paint(cerebrum_at, grey_matter_hu, cerebrum);
        voxel.paint(cerebrum_at + 4, white_matter_hu, cerebrum);
        const double leaves = 1.2 * portable_cos_turns((p.z + 0.15 * p.y) / 6.0);
        const double cerebellum_at =
            std::max(distance_to_ellipsoid(p, {0, 52, -12}, {46, 32, 20}) + leaves, surface);
        voxel.paint(cerebellum_at, grey_matter_hu, cerebellum);
        voxel.paint(distance_to_rod(p, {0, 16, 8}, {0, 34, -60}, 13, 8), white_matter_hu,
                    brain_stem);
        double inside = distance_to_rod(q, {9, -26, 36}, {13, 22, 48}, 5, 6);
        inside = smooth_union(inside, distance_to_rod(q, {13, 22, 48}, {26, 40, 30}, 6, 5), 4);
        inside = smooth_union(inside, distance_to_rod(q, {26, 40, 30}, {33, 4, 10}, 4.5, 3), 4);
        inside = smooth_union(inside, distance_to_rod(p, {0, 0, 30}, {0, 14, 18}, 3, 3), 3);
        voxel.paint(inside, fluid_hu, ventricles);
    }

    static void paint_eye(Voxel& voxel, const dvec3& q) {
        voxel.paint(distance_to_rod(q, {30, -62, 4}, {17, -40, 2}, 2.6, 2.4), 40, soft_tissue);
        const double ball = distance_to_ellipsoid(q, {32, -72, 4}, {12, 12, 12});
        voxel.paint(ball, 45, eyes);
        voxel.paint(ball + 2, eye_hu, eyes);
        voxel.paint(distance_to_ellipsoid(q, {32, -81, 4}, {4.8, 2.4, 4.8}), lens_hu, eyes);
    }

    std::vector<PlacedTooth> upper_ = placed_teeth(upper_arch, -49, -1);
    std::vector<PlacedTooth> lower_ = placed_teeth(lower_arch, -72, 1);
};

Grid head_grid() {
    Grid grid;
    grid.size = head_size;
    grid.origin = first_sample;
    for (int axis = 0; axis < 3; ++axis) {
        grid.step[static_cast<std::size_t>(axis)] = dvec3(0);
        grid.step[static_cast<std::size_t>(axis)][axis] = voxel_edge;
    }
    grid.centering.fill(Centering::cell);
    grid.axes = WorldAxes::left_posterior_superior;
    grid.unit = "mm";
    return grid;
}

// Calls store(index of a sample, voxel) for all samples.
template <typename Store>
void for_each_voxel(const char* what, const Store& store) {
    const Head head;
    Progress progress(what, head_size[2]);
    parallel_for(head_size[1] * head_size[2], 8, [&](std::int64_t row) {
        const std::int64_t y = row % head_size[1], z = row / head_size[1];
        dvec3 p = first_sample + voxel_edge * dvec3{0, y, z};
        std::vector<double> folds(head_size[0]), grain(head_size[0]);
        const auto add = [&](std::uint64_t seed, double size, double amplitude,
                             std::vector<double>& values) {
            GradientNoise(seed).add_row(p.x / size, voxel_edge / size, p.y / size, p.z / size,
                                        amplitude, static_cast<int>(values.size()), values.data());
        };
        add(0x4ead0, 17, 1, folds);
        add(0x4ead1, 9, 0.4, folds);
        add(0x4ead2, 7, 1, grain);
        add(0x4ead3, 3.5, 0.8, grain);
        for (std::int64_t x = 0; x < head_size[0]; ++x) {
            p.x = first_sample.x + voxel_edge * static_cast<double>(x);
            const auto i = static_cast<std::size_t>(x);
            store(row * head_size[0] + x, head.at(p, folds[i], grain[i]));
        }
        if (y == 0) progress.advance();
    });
}

// Returns names and colours of the tissues.
std::vector<Label> tissue_labels() {
    std::vector<Label> labels;
    const auto add = [&](int tissue, const char* name, const glm::dvec3& display) {
        glm::dvec3 color;
        for (int c = 0; c < 3; ++c) color[c] = linear_from_srgb(display[c]);
        labels.push_back({.number = std::to_string(tissue), .name = name, .color = color});
    };
    add(skull, "skull", {0.90, 0.82, 0.62});
    add(jaw, "jaw", {0.80, 0.62, 0.40});
    add(teeth, "teeth", {0.76, 0.84, 0.95});
    add(spine, "spine", {0.60, 0.75, 0.45});
    add(cerebrum, "cerebrum", {0.90, 0.52, 0.50});
    add(cerebellum, "cerebellum", {0.66, 0.42, 0.78});
    add(brain_stem, "brain stem", {0.95, 0.70, 0.25});
    add(ventricles, "ventricles", {0.25, 0.52, 0.88});
    add(eyes, "eyes", {0.30, 0.70, 0.65});
    return labels;
}

}  // namespace

Volume head_ct() {
    const Grid grid = head_grid();
    const std::shared_ptr<void> samples =
        filled_memory(static_cast<std::size_t>(grid.sample_count()) * sizeof(std::int16_t));
    auto* const values = static_cast<std::int16_t*>(samples.get());
    for_each_voxel("making the head", [&](std::int64_t index, const Voxel& voxel) {
        const double noise =
            normal_number(mixed_bits(static_cast<std::uint64_t>(index) + 0x4ead000000000000));
        values[index] = static_cast<std::int16_t>(
            std::floor(std::max(voxel.hu + scanner_noise * noise, -1024.0) + 0.5));
    });
    return Volume(grid, SampleType::int16, samples).measuring({"", "HU"});
}

Volume head_labels() {
    Grid grid = head_grid();
    grid.lookup = VolumeLookup::nearest;
    const std::shared_ptr<void> samples =
        filled_memory(static_cast<std::size_t>(grid.sample_count()));
    auto* const values = static_cast<std::uint8_t*>(samples.get());
    for_each_voxel("making the labels", [&](std::int64_t index, const Voxel& voxel) {
        values[index] = voxel.tissue == soft_tissue ? nothing : voxel.tissue;
    });
    return with_descriptions({grid, SampleType::uint8, samples}, tissue_labels());
}

}  // namespace lamina
