// SPDX-License-Identifier: Apache-2.0
#include "selftest/picture_bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "base/enum_words.h"
#include "base/parallel.h"
#include "optics/segment_integral.h"
#include "selftest/layered_pieces.h"
#include "selftest/pixel_bounds.h"

namespace lamina::selftest {

MeshChords::MeshChords(const SceneMesh& mesh, const View& view, double face_error)
    : eye_(view.eye) {
    for (const Tet& tet : mesh.mesh.tets()) {
        std::array<glm::dvec3, 4> at;
        std::array<double, 4> value{};
        for (std::size_t i = 0; i < 4; ++i) {
            at[i] = mesh.mesh.points()[static_cast<std::size_t>(tet[i])] - eye_;
            value[i] = mesh.scalar.values[static_cast<std::size_t>(tet[i])];
        }
        const double volume = glm::dot(glm::cross(at[1] - at[0], at[2] - at[0]), at[3] - at[0]);
        if (volume == 0 || !std::all_of(value.begin(), value.end(),
                                        [](double each) { return std::isfinite(each); }))
            continue;
        Solid& solid = solids_.emplace_back();
        solid.scalars = {value[0], value[0]};
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec3 &a = at[(i + 1) % 4], &b = at[(i + 2) % 4], &c = at[(i + 3) % 4];
            glm::dvec3 normal = glm::cross(b - a, c - a);
            const double area = glm::length(normal);
            const double height = glm::dot(normal, at[i] - a);
            solid.gradient += value[i] / height * normal;
            normal = (height > 0 ? -1 : 1) / area * normal;
            solid.normals[i] = normal;
            solid.offsets[i] = glm::dot(normal, a);
            solid.scalars.include(value[i]);
            for (std::size_t j = 0; j < i; ++j)
                solid.error = std::max(solid.error, face_error * glm::length(at[i] - at[j]));
        }
        solid.scalar_at_eye = value[0] - glm::dot(solid.gradient, at[0]);
    }
}

Interval MeshChords::parameters_inside(const Solid& solid, const View::Ray& ray,
                                       const glm::dvec3& from_eye, double outwards) {
    Interval inside{0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < 4; ++i) {
        const double speed = glm::dot(solid.normals[i], ray.direction);
        const double distance = solid.offsets[i] + outwards - glm::dot(solid.normals[i], from_eye);
        if (speed > 0) inside.hi = std::min(inside.hi, distance / speed);
        if (speed < 0) inside.lo = std::max(inside.lo, distance / speed);
        if (speed == 0 && distance < 0) return {};
    }
    return inside.lo < inside.hi ? inside : Interval{};
}

MeshChords::Along MeshChords::along(const View::Ray& ray,
                                    const TransferFunction& transfer_function) const {
    Along sum;
    const glm::dvec3 from_eye = ray.origin - eye_;
    const double per_parameter = glm::length(ray.direction);
    for (const Solid& solid : solids_) {
        const Interval widest = parameters_inside(solid, ray, from_eye, solid.error);
        if (!(widest.width() > 0)) continue;
        const Interval inside = parameters_inside(solid, ray, from_eye, 0);
        const Interval narrowest = parameters_inside(solid, ray, from_eye, -solid.error);
        const auto scalar_at = [&](double parameter) {
            const glm::dvec3 at = from_eye + parameter * ray.direction;
            return std::clamp(solid.scalar_at_eye + glm::dot(solid.gradient, at), solid.scalars.lo,
                              solid.scalars.hi);
        };
        const double length = inside.width() * per_parameter;
        const double depth =
            integrate_segment(transfer_function, scalar_at(inside.lo), scalar_at(inside.hi), length)
                .optical_depth;
        const double most = optics_range(transfer_function, solid.scalars).extinction.hi;
        ++sum.crossed;
        sum.depth += depth;
        sum.length_error += (widest.width() - narrowest.width()) * per_parameter;
        sum.possible_depth.lo +=
            std::max(0.0, depth - most * (inside.width() - narrowest.width()) * per_parameter);
        sum.possible_depth.hi += depth + most * (widest.width() - inside.width()) * per_parameter;
    }
    return sum;
}

namespace {

constexpr Interval everything{-1e30, 1e30};

// Rounding of the position in a table of 256 x 256 colour weights: float32 divides a cell into 2^24
// parts. Opacity does not come from a table.
constexpr double place_in_table = 0x1p-32;

// Error of light from stored gradients: direction and weight are off by at most 2^-15
// (slicing/gradient_map.h), and the power n of a highlight by n 2^-21.
constexpr double light_error = 0x1p-14;

// Returns the largest number of pieces that a tet is cut into.
double parts_in(const TransferFunction& transfer_function) {
    return static_cast<double>(transfer_function.knots().size() + 1);
}

// Returns the number of tets into which the clip may cut one: up to three for each plane.
double tets_for_one(const LayeredBox& box) {
    return std::pow(3, static_cast<double>(box.cuts.size()));
}

void widen(PixelBounds& pixel, double absolute, double relative, double of_color = 0) {
    for (Interval& channel : pixel) channel = channel.widened(absolute + relative * channel.hi);
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = pixel[c].widened(of_color);
    pixel[3] = pixel[3].within({0, 1});
    for (Interval& channel : pixel) channel.lo = std::max(channel.lo, 0.0);
}

// Returns a bound on the error of a picture by the codes of a tree's inner images. If a code is off
// by h, the final opacity moves by at most Y h times its node's weight (docs/numerics.md, section
// 4). All nodes of a level together, each behind those in front of it, move it by at most 7 Y h:
// nodes with sigma <= 1 by e Y h, since their shares add up to 1; nodes with 1 < sigma <= 1/w by e
// Y h, since depths in front of each other add up to no more; others by 1.58 Y h, a geometric
// series of 1/e. Colours move by as much again through the weights, and by h through their codes.
double tree_error(const TreeSettings& tree, double code) {
    double sum = code;  // of the root
    double share = 1;
    for (std::size_t level = 0; level + 1 < tree.factors.size(); ++level) {
        share /= tree.factors[level];
        const double y = 1 + std::log(1 / share) / std::numbers::e;
        sum += (14 * y + 1) * code / 2;
    }
    return sum;
}

double code_step(Target target) {
    switch (target) {
        case Target::fixed8:
            return 1.0 / 255;
        case Target::fixed16:
            return 1.0 / 65535;
        case Target::float16:
            return 0x1p-10;
        case Target::float32:
        case Target::emulated:
            return 0x1p-23;
    }
    unreachable_enum();
}

// Returns the precision of a way to draw. World coordinates have 53 bits, so far from the origin a
// small box loses some.
Precision precision_of(const LayeredBox& box, const DrawingWay& way) {
    Precision precision = way.method == Method::trace ? Precision::traced() : Precision::drawn();
    double shortest = box.longest_edge();
    for (const glm::dvec3& edge : box.edges) shortest = std::min(shortest, glm::length(edge));
    const double lost = 0x1p-49 * glm::length(box.corner) / shortest;
    precision.position += lost;
    precision.face += lost;
    return precision;
}

template <typename Pixel>
PictureBounds all_pixels(const Scene& scene, const Pixel& pixel) {
    const View view(*scene.camera, scene.width, scene.height);
    PictureBounds picture{scene.width, scene.height, {}, {}};
    const std::int64_t count = std::int64_t{scene.width} * scene.height;
    picture.exact.resize(static_cast<std::size_t>(count));
    picture.possible.resize(static_cast<std::size_t>(count));
    parallel_for(count, 1, [&](std::int64_t i) {
        const auto at = static_cast<std::size_t>(i);
        pixel(view.ray(static_cast<double>(i % scene.width), static_cast<double>(i / scene.width)),
              picture.exact[at], picture.possible[at]);
    });
    return picture;
}

// Collects the Fit of a picture from its pixels and channels, one after the other.
class Judge {
  public:
    explicit Judge(int width) : width_(width) {}

    void see(std::size_t pixel, std::size_t channel, double value, double exact,
             const Interval& possible) {
        const double error = std::abs(value - exact);
        if (!std::isfinite(value)) return reject(pixel, channel, "is no finite number");
        fit_.largest_error = std::max(fit_.largest_error, 255 * error);
        const double bound = std::max(std::abs(possible.lo - exact), std::abs(possible.hi - exact));
        const double outside = std::max({0.0, possible.lo - value, value - possible.hi});
        if (outside > 0 && outside > outside_) {
            outside_ = outside;
            fit_.error = 255 * error;
            fit_.bound = 255 * bound;
            reject(pixel, channel,
                   fmt::format("is {:.9g}, expected {:.9g} to {:.9g}", value, possible.lo,
                               possible.hi));
        }
        const bool nearer = error * fit_.bound > fit_.error * bound;
        if (fit_.fits && bound > 0 && (nearer || fit_.bound == 0)) {
            fit_.error = 255 * error;
            fit_.bound = 255 * bound;
        }
    }
    const Fit& fit() const { return fit_; }

  private:
    void reject(std::size_t pixel, std::size_t channel, const std::string& what) {
        fit_.fits = false;
        const auto width = static_cast<std::size_t>(width_);
        fit_.where = fmt::format("pixel {}, {}, channel {} {}", pixel % width, pixel / width,
                                 "RGBA"[channel], what);
    }

    int width_;
    double outside_ = 0;
    Fit fit_;
};

}  // namespace

PictureBounds layered_picture(const SelftestScene& subject, const DrawingWay& way,
                              const SceneMesh* mesh) {
    const Scene scene = way.scene_of(subject.scene);
    const LayeredBox& box = subject.box;
    const TransferFunction& optics = *scene.transfer_function;
    const Precision precision = precision_of(box, way);
    const View view(*scene.camera, scene.width, scene.height);
    std::optional<MeshChords> chords;
    if (mesh) chords.emplace(*mesh, view, precision.face);
    const bool sliced = way.method == Method::slice;
    const Slabs slabs = slabs_of(box, view, scene.slice.samples.value_or(1));
    const bool post = scene.slice.classification == Classification::post;
    const bool by_slab = sliced && scene.slice.classification != Classification::exact;
    // A ray may end as soon as the rest changes the picture by at most this (docs/omissions.md).
    const double hidden_light = scene.max_error / 255 / 1024;

    return all_pixels(scene, [&](const View::Ray& ray, std::array<double, 4>& exact,
                                 PixelBounds& possible) {
        exact = composite_exactly(exact_pieces(box, optics, ray));
        if (by_slab) {
            possible = composite(post ? middle_pieces(box, optics, ray, slabs, precision)
                                      : run_pieces(box, optics, ray, slabs, precision),
                                 way.rounding);
            widen(possible, hidden_light, 0);
            if (scene.slice.tree)
                widen(possible, tree_error(*given_tree(scene.slice.tree), code_step(*scene.target)),
                      0x1p-20);
        } else {
            double length_error = 3 * precision.position * box.longest_edge();
            double blends = static_cast<double>(box.layers());
            if (chords) {
                const MeshChords::Along along = chords->along(ray, optics);
                length_error = tets_for_one(box) * along.length_error;
                blends = tets_for_one(box) * along.crossed * parts_in(optics);
            }
            possible = composite(tet_pieces(box, optics, ray, length_error, precision), {});
            widen(possible, blends * way.rounding.absolute(), blends * way.rounding.relative);
            if (way.method == Method::trace)
                widen(possible, scene.trace_tolerance, precision.relative);
            else
                widen(possible, 0, 0, blends * place_in_table);
        }
        if (scene.lighting) {
            const OneGradientLight light(**scene.lighting, box, ray);
            light.shine_on(exact);
            light.shine_on(possible, way.method == Method::trace ? 1e-12 : light_error);
        }
        widen(possible, 0, 0x1p-23);  // the picture is stored in float32
    });
}

PictureBounds one_color_picture(const Scene& base, const DrawingWay& way, const SceneMesh& mesh) {
    const Scene scene = way.scene_of(base);
    const Precision precision =
        way.method == Method::trace ? Precision::traced() : Precision::drawn();
    const MeshChords chords(mesh, View(*scene.camera, scene.width, scene.height), precision.face);
    const TransferFunction& optics = *scene.transfer_function;
    const OpticsRange all = optics_range(optics, everything);
    return all_pixels(scene, [&](const View::Ray& ray, std::array<double, 4>& exact,
                                 PixelBounds& possible) {
        const MeshChords::Along along = chords.along(ray, optics);
        const double share = precision.relative + 2 * precision.scalar;
        const Interval alpha{-std::expm1(-along.possible_depth.lo * (1 - share)),
                             -std::expm1(-along.possible_depth.hi * (1 + share))};
        const double blends = along.crossed * parts_in(optics);
        for (std::size_t c = 0; c < 4; ++c) {
            const double color = c < 3 ? all.color[c].hi : 1;
            exact[c] = color * -std::expm1(-along.depth);
            possible[c] = {color * alpha.lo, color * alpha.hi};
        }
        widen(possible, blends * way.rounding.absolute(), blends * way.rounding.relative + 0x1p-20);
        widen(possible, way.method == Method::trace ? scene.trace_tolerance : 0, 0x1p-23);
    });
}

Fit fit_of(const PreciseImage& picture, const PictureBounds& bounds) {
    Judge judge(bounds.width);
    for (std::size_t pixel = 0; pixel < bounds.exact.size(); ++pixel) {
        for (std::size_t c = 0; c < 4; ++c)
            judge.see(pixel, c, picture.rgba[4 * pixel + c], bounds.exact[pixel][c],
                      bounds.possible[pixel][c]);
    }
    return judge.fit();
}

Fit fit_of(const PreciseImage& a, const PictureBounds& bounds_a, const PreciseImage& b,
           const PictureBounds& bounds_b) {
    Judge judge(bounds_a.width);
    for (std::size_t pixel = 0; pixel < bounds_a.exact.size(); ++pixel) {
        for (std::size_t c = 0; c < 4; ++c) {
            Interval both = bounds_a.possible[pixel][c];
            both.include(bounds_b.possible[pixel][c]);
            const double difference = b.rgba[4 * pixel + c] - a.rgba[4 * pixel + c];
            judge.see(pixel, c, difference, 0, {-both.width(), both.width()});
        }
    }
    return judge.fit();
}

}  // namespace lamina::selftest
