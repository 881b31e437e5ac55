// SPDX-License-Identifier: Apache-2.0
#include "plain/plain_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "base/client.h"
#include "base/parallel.h"
#include "scene/camera.h"
#include "scene/clip.h"
#include "volume/volume_store.h"

namespace lamina {
namespace {

constexpr auto largest = [](const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); };

// A number or vector that is c[0] + c[1] t + c[2] t^2 + c[3] t^3.
template <typename T>
struct Cubic {
    T c[4];
    T at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    Cubic slope() const { return {c[1], 2. * c[2], 3. * c[3], T(0)}; }
    // Returns at(from + step t) as a cubic of t, by Taylor's series.
    Cubic part(double from, double step) const {
        return {at(from), step * slope().at(from), step * step / 2 * slope().slope().at(from),
                step * step * step * c[3]};
    }
};

// Appends the places between 0 and 1 at which p crosses 0. It is monotone between the zeros of its
// slope, so that it crosses 0 there at most once, and bisection finds the place.
void append_crossings(const Cubic<double>& p, std::vector<double>& places) {
    std::vector<double> ends;
    if (p.c[1] != 0 || p.c[2] != 0 || p.c[3] != 0) append_crossings(p.slope(), ends);
    ends.push_back(1);
    for (double from = 0; const double end : ends) {
        const bool below = p.at(from) < 0, crosses = (p.at(end) < 0) != below;
        double to = end;
        for (int halving = 0; crosses && halving < 60; ++halving) {
            const double middle = 0.5 * (from + to);
            ((p.at(middle) < 0) == below ? from : to) = middle;
        }
        if (crosses) places.push_back(to);
        from = end;
    }
}

// Returns a place's distance from the plane, > 0 inside, times the length of the normal.
double depth_in(const HalfSpace& half, const glm::dvec3& place) {
    return glm::dot(half.normal, place - half.point);
}

// The part from <= z <= to of a ray; none unless from < to.
struct Span {
    double from, to;
};

// Cuts away everything outside a half space. `keeps_plane`: a ray in its plane is inside.
void cut(Span& span, const HalfSpace& half, bool keeps_plane, const View::Ray& ray) {
    const double start = depth_in(half, ray.origin), slope = glm::dot(half.normal, ray.direction);
    if (slope > 0) span.from = std::max(span.from, -start / slope);
    if (slope < 0) span.to = std::min(span.to, -start / slope);
    if (slope == 0 && !(start > 0 || (start == 0 && keeps_plane))) span.to = -INFINITY;
}
using Field = glm::dvec4;  // the gradient in world space (x, y, z) and the scalar (w)

// A part of a ray in one cell or tet, and the field from t = 0 at its front to t = 1 at its back.
struct Segment {
    double entry;   // z at which the ray enters the cell or tet, visible or not
    double length;  // world units of its visible part
    Cubic<Field> field;
};
double scalar_at(const Volume& volume, const glm::dvec3& index) {
    const auto& size = volume.grid().size;
    const glm::i64vec3 i(index);
    const std::int64_t n = i.x + size[0] * (i.y + size[1] * i.z);
    return visit_samples(volume, [&](const auto& all) { return static_cast<double>(all[n]); });
}

// Returns the field at a sample; samples outside the grid repeat the border's. Gradients are
// differences of neighbours that exist and are finite (docs/numerics.md, section 10); 0 in voxels.
Field field_at(const Volume& volume, const glm::dvec3& place) {
    const auto& size = volume.grid().size;
    const glm::dvec3 last = glm::dvec3(size[0], size[1], size[2]) - 1.;
    const glm::dvec3 index = glm::clamp(place, glm::dvec3(0), last);
    Field found(0, 0, 0, scalar_at(volume, index));
    for (int axis = 0; axis < 3 && volume.grid().lookup == VolumeLookup::linear; ++axis) {
        glm::dvec3 low = index, high = index;
        if (--low[axis] < 0 || !std::isfinite(scalar_at(volume, low))) low = index;
        if (++high[axis] > last[axis] || !std::isfinite(scalar_at(volume, high))) high = index;
        if (low == high) continue;
        const glm::dvec3& step = volume.grid().step[axis];
        const double change = scalar_at(volume, high) - scalar_at(volume, low);
        found += Field(change / (high[axis] - low[axis]) * (step / glm::dot(step, step)), 0);
    }
    return found;
}

// Returns a + x (b - a) for x that runs from x0 to x1: its degree is one more than that of a and b.
Cubic<Field> mixed(Cubic<Field> a, const Cubic<Field>& b, double x0, double x1) {
    for (int i = 3; i > 0; --i)
        a.c[i] += x0 * (b.c[i] - a.c[i]) + (x1 - x0) * (b.c[i - 1] - a.c[i - 1]);
    a.c[0] += x0 * (b.c[0] - a.c[0]);
    return a;
}

// Cuts a ray at all faces of cells, or of voxels, whose corners are all one sample. Fields are
// mixed along one axis after the other (docs/numerics.md, section 9), and NaN if a corner is NaN.
std::vector<Segment> meet(const Volume& volume, const View::Ray& world, Span seen) {
    const Grid& grid = volume.grid();
    const View::Ray ray{grid.to_index(world.origin), grid.direction_to_index(world.direction)};
    const glm::dvec3 lowest = grid.index_min(), highest = grid.index_max();
    const double reach = grid.lookup == VolumeLookup::nearest ? 0 : 1;
    std::vector<double> ends;
    for (int axis = 0; axis < 3; ++axis) {
        cut(seen, {lowest, glm::dmat3(1)[axis]}, true, ray);
        cut(seen, {highest, -glm::dmat3(1)[axis]}, true, ray);
        for (double plane = std::ceil(lowest[axis]); plane <= highest[axis]; ++plane)
            ends.push_back((plane - ray.origin[axis]) / ray.direction[axis]);
    }
    std::erase_if(ends, [&](double z) { return !(seen.from < z && z < seen.to); });
    ends.push_back(seen.to);
    std::sort(ends.begin(), ends.end());
    const auto place = [&](double z) { return ray.origin + z * ray.direction; };
    std::vector<Segment> found;
    for (double from = seen.from; const double to : ends) {
        if (!(from < to)) continue;
        const glm::dvec3 middle = glm::floor(place(0.5 * (from + to)));
        const glm::dvec3 cell = glm::clamp(middle, glm::floor(lowest), glm::ceil(highest) - 1.);
        const auto inside = [&](double z) { return glm::clamp(place(z) - cell, 0., 1.); };
        const glm::dvec3 a = inside(from), b = inside(to);
        Cubic<Field> p[8]{};
        for (int i = 0; i < 8; ++i)
            p[i].c[0] = field_at(volume, cell + reach * glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
        for (int i = 0; i < 4; ++i) p[i] = mixed(p[2 * i], p[2 * i + 1], a.x, b.x);
        for (int i = 0; i < 2; ++i) p[i] = mixed(p[2 * i], p[2 * i + 1], a.y, b.y);
        const Cubic<Field> field = mixed(p[0], p[1], a.z, b.z);
        const double length = (to - from) * glm::length(world.direction);
        if (std::isfinite(field.at(0.5).w)) found.push_back({from, length, field});
        from = to;
    }
    return found;
}

struct PlainMesh {
    std::span<const glm::dvec3> points;
    std::vector<Field> fields;  // one a point
    std::vector<Tet> tets;      // the visible ones
    double first_entry = 0;     // z at which tets that begin before it count as entered
    double tie = 0;             // world units within which two tets are entered at one place
    // Returns the half space behind the face opposite a corner, which the tet is in. Both tets of a
    // face begin with its least place, so that their planes are equal to the last bit.
    HalfSpace behind(const Tet& tet, int opposite) const {
        auto face = corners_of_face(tet, opposite);
        const auto place = [&](int i) { return std::array{points[i].x, points[i].y, points[i].z}; };
        std::ranges::rotate(face, std::ranges::min_element(face, {}, place));
        const glm::dvec3 a = points[face[0]];
        return {a, glm::cross(points[face[2]] - a, points[face[1]] - a)};
    }
    // Interpolates. A corner's weight is the height over its opposite face, as a share of its own.
    Field field(const Tet& tet, const glm::dvec3& place) const {
        Field sum = fields[tet[0]];
        for (int i = 1; i < 4; ++i) {
            const HalfSpace half = behind(tet, i);
            const double share = depth_in(half, place) / depth_in(half, points[tet[i]]);
            sum += std::clamp(share, 0., 1.) * (fields[tet[i]] - fields[tet[0]]);
        }
        return sum;
    }
};

// Keeps tets with volume and finite values. The gradient at a point is the mean of those of the
// tets around it and its copies of one value, weighted by volume (docs/numerics.md, section 10).
PlainMesh plain_mesh(const Scene& scene, const SceneMesh& data) {
    const View view(*scene.camera, scene.width, scene.height);
    const auto& [low, high] = data.mesh.bounds();
    const bool perspective = view.projection == Projection::perspective;
    const glm::dvec3 far = glm::max(glm::abs(low - view.eye), glm::abs(high - view.eye));
    const double tie = 1e-10 * glm::length(perspective ? far : high - low);
    PlainMesh mesh{data.mesh.points(), {}, {}, perspective ? 0 : -INFINITY, tie};
    for (const double scalar : data.scalar.values) mesh.fields.emplace_back(0, 0, 0, scalar);
    const std::vector<std::int32_t> firsts = equal_points(data.mesh, data.scalar.values);
    const auto first = [&](std::int32_t i) { return firsts.empty() ? i : firsts[i]; };
    std::vector<Field> sums(mesh.fields.size(), Field(0));  // volume times gradient, volume
    for (const Tet& tet : data.mesh.tets()) {
        Field sum(0);
        bool shows = true;
        for (int i = 0; i < 4; ++i) {
            const HalfSpace half = mesh.behind(tet, i);
            const double change = mesh.fields[tet[i]].w - mesh.fields[tet[0]].w;
            const double height = depth_in(half, mesh.points[tet[i]]);
            sum += Field(change * half.normal, height / 4);
            shows = shows && std::isfinite(change) && height > 0;
        }
        if (!shows) continue;
        mesh.tets.push_back(tet);
        for (const std::int32_t corner : tet) sums[first(corner)] += sum;
    }
    for (std::int32_t i = 0; i < std::ssize(sums); ++i)
        if (const Field& s = sums[first(i)]; s.w > 0)
            mesh.fields[i] += Field(glm::dvec3(s) / s.w, 0);
    return mesh;
}

// Intersects a ray with all tets. A ray in a face counts as moved along x by infinitely little,
// along y by far less, and along z by far less again (docs/numerics.md, section 7).
std::vector<Segment> meet(const PlainMesh& mesh, const View::Ray& ray, const Span& seen) {
    std::vector<Segment> found;
    for (const Tet& tet : mesh.tets) {
        Span span{-INFINITY, INFINITY};
        for (int i = 0; i < 4; ++i) {
            const HalfSpace half = mesh.behind(tet, i);
            cut(span, half, glm::dot(half.normal, {1, 1e-50, 1e-100}) > 0, ray);
        }
        const double entry = span.from;
        span = {std::max(entry, seen.from), std::min(span.to, seen.to)};
        if (!(span.from < span.to)) continue;
        const Field front = mesh.field(tet, ray.origin + span.from * ray.direction);
        const Field back = mesh.field(tet, ray.origin + span.to * ray.direction);
        const double length = (span.to - span.from) * glm::length(ray.direction);
        found.push_back({entry, length, {front, back - front}});
    }
    // Sorts tets, now in the order of their numbers, by entry. Tets entered at one place get the
    // entry of the first one of them, and so keep the order of their numbers.
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < found.size(); ++i)
        order.emplace_back(std::max(found[i].entry, mesh.first_entry), i);
    std::ranges::sort(order);
    const double tie = mesh.tie / glm::length(ray.direction);
    double last = -INFINITY;  // entry of the segment before, as it was
    for (std::size_t i = 0; i < order.size(); ++i) {
        const double entry = order[i].first;
        if (entry - std::exchange(last, entry) <= tie) order[i].first = order[i - 1].first;
    }
    std::ranges::sort(order);
    std::vector<Segment> sorted;
    for (const auto& [entry, i] : order) sorted.push_back(found[i]);
    return sorted;
}

// Adds up the light of a ray, front to back (docs/numerics.md, sections 1 and 10).
class PlainRay {
  public:
    glm::dvec3 color{0};
    double depth = 0, error = 0;
    PlainRay(const Scene& scene, const View::Ray& ray, const std::vector<Segment>& segments)
        : scene_(scene) {
        for (const TransferKnot& knot : scene.transfer_function->knots())
            brightest_ = std::max(brightest_, largest(knot.optics.color));
        if (scene.lighting) take(**scene.lighting, -glm::normalize(ray.direction));
        for (const Segment& segment : segments) {
            const std::vector<double> ends = cuts(segment.field);
            for (std::size_t i = 1; i < ends.size(); ++i) add(segment, ends[i - 1], ends[i], 0);
        }
    }

  private:
    void take(const Lighting& lighting, const glm::dvec3& eye) {
        glm::dvec3 sum(0);
        for (const auto& [given, shone] : lighting.lights) {
            const glm::dvec3 v = given ? *given / largest(glm::abs(*given)) : eye;
            const glm::dvec3 light = glm::normalize(v), both = light + eye;
            const bool opposite = glm::length(both) < 1e-12;
            lights_.push_back({light, opposite ? glm::dvec3(0) : glm::normalize(both), shone});
            sum += shone;
        }
        brightest_ *= 1 + lighting.ambient + lighting.diffuse * largest(sum);
        brightest_ += lighting.specular * largest(sum);
    }
    // Returns a segment's ends, turns, knots, and kinks of light (gradients square to its vectors).
    std::vector<double> cuts(const Cubic<Field>& field) const {
        const auto along = [&c = field.c](const Field& v, double less) {
            return Cubic<double>{dot(c[0], v) - less, dot(c[1], v), dot(c[2], v), dot(c[3], v)};
        };
        std::vector<double> found{0, 1};
        append_crossings(along({0, 0, 0, 1}, 0).slope(), found);
        const auto scalar = [&](double t) { return field.at(t).w; };
        const auto [least, most] = std::ranges::minmax(found, {}, scalar);
        const auto knots = scene_.transfer_function->knots();
        auto knot = std::ranges::upper_bound(knots, scalar(least), {}, &TransferKnot::value);
        for (; knot != knots.end() && knot->value < scalar(most); ++knot)
            append_crossings(along({0, 0, 0, 1}, knot->value), found);
        for (const auto& [light, halfway, shone] : lights_)
            for (const glm::dvec3& v : {light, halfway}) append_crossings(along({v, 0}, 0), found);
        std::sort(found.begin(), found.end());
        return found;
    }
    // Returns colour and extinction, per unit of t.
    glm::dvec4 optics(const Segment& segment, double t) const {
        const OpticalProperties found = scene_.transfer_function->at(segment.field.at(t).w);
        return {found.color, std::min(found.extinction, 1e200) * segment.length};
    }
    // Returns the optical depth, by Gauss' rule with two points, which is exact for cubics.
    double thickness(const Segment& segment, double from, double to) const {
        const double half = 0.5 * (to - from), first = half * (1 - 1 / std::sqrt(3.));
        return half * (optics(segment, from + first).w + optics(segment, to - first).w);
    }
    glm::dvec3 shade(const Segment& segment, double t) const {
        const glm::dvec3 c(optics(segment, t)), gradient(segment.field.at(t));
        const double steepness = glm::length(gradient);
        if (!scene_.lighting || steepness == 0) return c;
        const Lighting& lighting = **scene_.lighting;
        const double w = 1 / (1 + std::pow(*lighting.smallest_gradient / steepness, 2));
        glm::dvec3 lit = lighting.ambient * c;
        for (const auto& [light, halfway, shone] : lights_) {
            const double cosine = std::abs(glm::dot(gradient, light)) / steepness;
            const double shine = std::abs(glm::dot(gradient, halfway)) / steepness;
            lit += shone * (lighting.diffuse * cosine * c +
                            lighting.specular * std::pow(shine, lighting.power));
        }
        return glm::mix(c, lit, w);
    }
    // Integrates the visible colour, by Gauss' rule with six points.
    glm::dvec3 gauss(const Segment& segment, double from, double to, double in_front) const {
        constexpr double nodes[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
        constexpr double weights[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
        const double half = 0.5 * (to - from);
        glm::dvec3 sum(0);
        for (int i = 0; i < 6; ++i) {
            const double t = from + half * (1 + (i < 3 ? nodes[i] : -nodes[i - 3]));
            const double seen = std::exp(-in_front - thickness(segment, from, t));
            sum += half * weights[i % 3] * seen * optics(segment, t).w * shade(segment, t);
        }
        return sum;
    }
    // Adds a part of a segment, halved until Gauss' rule on it and on its halves agree. Deep parts
    // and those on which the gradient turns are halved first: peaks may lie between nodes.
    void add(const Segment& segment, double from, double to, int halvings) {
        constexpr double tolerance = 1e-7, rounding = 1e-14;  // shares of opacity, of full scale
        const double middle = 0.5 * (from + to), here = thickness(segment, from, to);
        const double opacity = std::exp(-depth) * -std::expm1(-here);
        const double allowed = tolerance * opacity + rounding * brightest_;
        const Cubic<Field> near = segment.field.part(middle, 0.5 * (to - from));
        const auto size = [&](int i) { return glm::length(glm::dvec3(near.c[i])); };
        const bool turns = scene_.lighting && size(1) + size(2) + size(3) > 0.5 * size(0);
        glm::dvec3 seen = opacity * shade(segment, middle);
        double off = opacity * brightest_;
        if (off > allowed && here <= 1 && !turns) {
            const double behind = depth + thickness(segment, from, middle);
            seen = gauss(segment, from, middle, depth) + gauss(segment, middle, to, behind);
            off = largest(glm::abs(seen - gauss(segment, from, to, depth)));
        }
        if (off > allowed && halvings < 60) {
            add(segment, from, middle, halvings + 1);
            return add(segment, middle, to, halvings + 1);
        }
        color += seen;
        error += off;
        depth += here;
    }

    const Scene& scene_;
    double brightest_ = 1;                           // bound on lit colours and on opacity
    std::vector<std::array<glm::dvec3, 3>> lights_;  // direction, halfway vector, colour
};

template <typename Data>
PlainPicture trace(const Scene& scene, const Data& data) {
    const View view(*scene.camera, scene.width, scene.height);
    const std::vector<HalfSpace> clip = half_spaces(scene.clip);
    PlainPicture picture{PreciseImage(scene.width, scene.height)};
    Progress progress("tracing", scene.height);
    std::mutex adding;
    parallel_for(scene.height, 1, [&](std::int64_t row) {
        for (int column = 0; column < scene.width; ++column) {
            const View::Ray ray = view.ray(column, static_cast<double>(row));
            Span seen{0, INFINITY};
            for (const HalfSpace& half : clip) cut(seen, half, true, ray);
            const std::vector<Segment> segments = meet(data, ray, seen);
            const PlainRay found(scene, ray, segments);
            const glm::dvec4 rgba(found.color, -std::expm1(-found.depth));
            std::copy_n(&rgba[0], 4, picture.image.pixel(column, static_cast<int>(row)));
            const std::lock_guard lock(adding);
            picture.error_estimate = std::max(picture.error_estimate, found.error);
            picture.segments += static_cast<std::int64_t>(segments.size());
        }
        progress.advance();
    });
    return picture;
}
}  // namespace

PlainPicture trace_plainly(const Scene& scene, const Volume& volume) {
    return trace(scene, volume);
}
PlainPicture trace_plainly(const Scene& scene, const SceneMesh& mesh) {
    return trace(scene, plain_mesh(scene, mesh));
}
}  // namespace lamina
