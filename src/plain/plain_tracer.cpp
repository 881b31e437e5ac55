// SPDX-License-Identifier: Apache-2.0
#include "plain/plain_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <mutex>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "scene/camera.h"
#include "scene/half_space.h"
#include "volume/sample_access.h"

namespace lamina {
namespace {

std::size_t number(std::int64_t i) {
    return static_cast<std::size_t>(i);
}

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

glm::dvec3 unit_vector(const glm::dvec3& v) {
    return glm::normalize(v / largest(glm::abs(v)));
}

// --- cubics

template <typename T>
using Cubic = std::array<T, 4>;  // coefficients of 1, t, t^2 and t^3

template <typename T>
T value(const Cubic<T>& p, double t) {
    return p[0] + t * (p[1] + t * (p[2] + t * p[3]));
}

template <typename T>
Cubic<T> derivative(const Cubic<T>& p) {
    return {p[1], 2. * p[2], 3. * p[3], T(0)};
}

// p(from + step t) as a cubic of t, by Taylor's series.
template <typename T>
Cubic<T> around(const Cubic<T>& p, double from, double step) {
    const Cubic<T> slope = derivative(p);
    return {value(p, from), step * value(slope, from),
            step * step / 2 * value(derivative(slope), from), step * step * step * p[3]};
}

// Appends the places where p crosses a level. Between neighbours of `ends` it is monotone, so there
// it crosses the level at most once, and bisection finds the place.
void append_crossings(Cubic<double> p, double level, const std::vector<double>& ends,
                      std::vector<double>& places) {
    p[0] -= level;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        double from = ends[i - 1], to = ends[i];
        const bool below = value(p, from) < 0;
        if ((value(p, to) < 0) == below) continue;
        for (int halving = 0; halving < 60; ++halving) {
            const double middle = 0.5 * (from + to);
            ((value(p, middle) < 0) == below ? from : to) = middle;
        }
        places.push_back(to);
    }
}

// Gives 0, the places where p turns, and 1. p turns where its derivative crosses 0, which is
// monotone between the places where it turns itself; a straight line turns nowhere.
std::vector<double> monotone_ends(const Cubic<double>& p) {
    std::vector<double> ends{0};
    if (p[2] != 0 || p[3] != 0)
        append_crossings(derivative(p), 0, monotone_ends(derivative(p)), ends);
    ends.push_back(1);
    return ends;
}

// --- what a ray meets

// The part from <= z <= to of a ray; none unless from < to.
struct Span {
    double from = -INFINITY, to = INFINITY;
};

// Cuts away what lies outside a half space. `keeps_plane`: a ray in its plane is inside.
void cut(Span& span, const HalfSpace& half, bool keeps_plane, const View::Ray& ray) {
    const double distance = glm::dot(half.normal, ray.origin - half.point);
    const double slope = glm::dot(half.normal, ray.direction);
    if (slope > 0) span.from = std::max(span.from, -distance / slope);
    if (slope < 0) span.to = std::min(span.to, -distance / slope);
    if (slope == 0 && !(distance > 0 || (distance == 0 && keeps_plane))) span.to = -INFINITY;
}

using Field = glm::dvec4;  // the gradient in world space (x, y, z) and the scalar (w)

// A part of a ray in one cell or tet, and the field from t = 0 at its front to t = 1 at its back.
struct Segment {
    double entry;  // where the ray enters the cell or tet, be it seen or not
    Span seen;
    Cubic<Field> field;
};

// a + x (b - a) for x that runs from x0 to x1: of one degree more than a and b.
Cubic<Field> mixed(const Cubic<Field>& a, const Cubic<Field>& b, double x0, double x1) {
    Cubic<Field> sum = a;
    for (std::size_t i = 0; i < 4; ++i) sum[i] += x0 * (b[i] - a[i]);
    for (std::size_t i = 1; i < 4; ++i) sum[i] += (x1 - x0) * (b[i - 1] - a[i - 1]);
    return sum;
}

class PlainVolume {
  public:
    explicit PlainVolume(const Volume& volume) : grid_(volume.grid()) {
        visit_samples(volume, [&](const auto& samples) {
            sample_ = [samples](std::int64_t i) { return static_cast<double>(samples[i]); };
        });
    }

    // Cuts a ray at all planes of samples.
    std::vector<Segment> meet(const View::Ray& in_world, Span seen) const {
        const View::Ray ray{grid_.to_index(in_world.origin),
                            grid_.direction_to_index(in_world.direction)};
        std::vector<double> ends;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 normal(0);
            normal[axis] = 1;
            cut(seen, {grid_.index_min(), normal}, true, ray);
            cut(seen, {grid_.index_max(), -normal}, true, ray);
            for (double plane = grid_.index_max()[axis]; (plane = std::ceil(plane) - 1) >= 0;)
                ends.push_back((plane - ray.origin[axis]) / ray.direction[axis]);
        }
        ends.insert(ends.end(), {seen.from, seen.to});
        std::erase_if(ends, [&](double z) { return !(seen.from <= z && z <= seen.to); });
        std::sort(ends.begin(), ends.end());
        std::vector<Segment> found;
        for (std::size_t i = 1; i < ends.size(); ++i)
            if (ends[i - 1] < ends[i]) append_cell(ray, {ends[i - 1], ends[i]}, found);
        return found;
    }

  private:
    // Appends a part of a ray in index space, unless a corner of its cell has no value. The field
    // is trilinear (docs/numerics.md, section 9): it is mixed along one axis after the other.
    void append_cell(const View::Ray& ray, const Span& span, std::vector<Segment>& found) const {
        const auto place = [&](double z) { return ray.origin + z * ray.direction; };
        const glm::dvec3 cell =
            glm::clamp(glm::floor(place(0.5 * (span.from + span.to))),
                       glm::floor(grid_.index_min()), glm::ceil(grid_.index_max()) - 1.);
        const glm::dvec3 from = glm::clamp(place(span.from) - cell, 0., 1.);
        const glm::dvec3 to = glm::clamp(place(span.to) - cell, 0., 1.);
        std::array<Cubic<Field>, 8> corners{};
        for (std::size_t i = 0; i < 8; ++i) {
            corners[i][0] = field(cell + glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
            if (!std::isfinite(corners[i][0].w)) return;
        }
        for (int axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < std::size_t{4} >> axis; ++i)
                corners[i] = mixed(corners[2 * i], corners[2 * i + 1], from[axis], to[axis]);
        }
        found.push_back({span.from, span, corners[0]});
    }

    double scalar(const glm::dvec3& index) const {
        const glm::i64vec3 i(index);
        return sample_(i.x + grid_.size[0] * (i.y + grid_.size[1] * i.z));
    }

    // The field at a sample; outside the samples the border's repeats. Gradients are differences of
    // the neighbours that exist and are numbers (docs/numerics.md, section 10).
    Field field(const glm::dvec3& place) const {
        const glm::dvec3 last(grid_.size[0] - 1, grid_.size[1] - 1, grid_.size[2] - 1);
        const glm::dvec3 index = glm::clamp(place, glm::dvec3(0), last);
        Field found(0, 0, 0, scalar(index));
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 below = index, above = index;
            if (--below[axis] < 0 || !std::isfinite(scalar(below))) below = index;
            if (++above[axis] > last[axis] || !std::isfinite(scalar(above))) above = index;
            const double steps = above[axis] - below[axis];
            const glm::dvec3& step = grid_.step[number(axis)];
            if (steps > 0)
                found +=
                    Field((scalar(above) - scalar(below)) / steps * step / glm::dot(step, step), 0);
        }
        return found;
    }

    Grid grid_;
    std::function<double(std::int64_t)> sample_;
};

struct PlainTet {
    std::array<std::size_t, 4> points;
    std::array<HalfSpace, 4> faces;  // the tet is inside; face i lies opposite corner i
    std::array<double, 4> heights;   // of corners over faces, times the lengths of the normals
};

class PlainMesh {
  public:
    explicit PlainMesh(const SceneMesh& mesh) {
        for (const double scalar : mesh.scalar.values) fields_.emplace_back(0, 0, 0, scalar);
        for (std::size_t i = 0; i < mesh.mesh.tets().size(); ++i) {
            if (!std::ranges::binary_search(mesh.mesh.flat_tets(), static_cast<std::int32_t>(i)))
                add(mesh.mesh.tets()[i], mesh.mesh.points());
        }
        find_gradients();
    }

    // Holds a ray against all tets. A ray in a face counts as moved along x by infinitely little,
    // along y by far less, and along z by far less again, so that it is in one of the face's tets
    // (docs/numerics.md, section 7).
    std::vector<Segment> meet(const View::Ray& ray, const Span& seen) const {
        const glm::dvec3 moved(1, 1e-100, 1e-200);
        std::vector<Segment> found;
        for (const PlainTet& tet : tets_) {
            Span inside;
            for (const HalfSpace& face : tet.faces)
                cut(inside, face, glm::dot(face.normal, moved) > 0, ray);
            const Span part{std::max(inside.from, seen.from), std::min(inside.to, seen.to)};
            if (!(part.from < part.to)) continue;
            const Field front = field(tet, ray.origin + part.from * ray.direction);
            const Field back = field(tet, ray.origin + part.to * ray.direction);
            found.push_back({inside.from, part, {front, back - front}});
        }
        std::ranges::stable_sort(found, {}, &Segment::entry);
        return found;
    }

  private:
    // Adds a tet that has a volume and four values. Both tets of a face begin with its least point,
    // so that their planes are the same to the last bit.
    void add(const Tet& corners, std::span<const glm::dvec3> points) {
        PlainTet tet{};
        for (std::size_t i = 0; i < 4; ++i) {
            auto face = corners_of_face(corners, i);
            std::ranges::rotate(face, std::ranges::min_element(face));
            const auto& [a, b, c] = std::array{points[number(face[0])], points[number(face[1])],
                                               points[number(face[2])]};
            tet.points[i] = number(corners[i]);
            tet.faces[i] = {a, glm::cross(c - a, b - a)};
            tet.heights[i] = glm::dot(tet.faces[i].normal, points[tet.points[i]] - a);
            if (!(tet.heights[i] > 0 && std::isfinite(fields_[tet.points[i]].w))) return;
        }
        tets_.push_back(tet);
    }

    // The corners' barycentric coordinates are heights over the faces, as shares of their own.
    Field field(const PlainTet& tet, const glm::dvec3& place) const {
        Field sum = fields_[tet.points[0]];
        for (std::size_t i = 1; i < 4; ++i) {
            const double height = glm::dot(tet.faces[i].normal, place - tet.faces[i].point);
            sum += std::clamp(height / tet.heights[i], 0., 1.) *
                   (fields_[tet.points[i]] - fields_[tet.points[0]]);
        }
        return sum;
    }

    // Finds the gradients at the points: means over the tets around them, weighted by volume
    // (docs/numerics.md, section 10).
    void find_gradients() {
        std::vector<Field> sums(fields_.size(), Field(0));  // volume times gradient, volume
        for (const PlainTet& tet : tets_) {
            Field sum(0, 0, 0, tet.heights[0]);
            for (std::size_t i = 1; i < 4; ++i)
                sum += Field(
                    (fields_[tet.points[i]].w - fields_[tet.points[0]].w) * tet.faces[i].normal, 0);
            for (const std::size_t point : tet.points) sums[point] += sum;
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            if (sums[i].w > 0) fields_[i] += Field(glm::dvec3(sums[i]) / sums[i].w, 0);
    }

    std::vector<Field> fields_;  // at the points
    std::vector<PlainTet> tets_;
};

// --- what a ray sees

// A part of a segment between two knots of the transfer function, from t = 0 to t = 1.
struct Piece {
    glm::dvec4 lower, upper;  // colour and extinction at the knots
    double width;             // between the knots; 0 if both are one
    Cubic<Field> field;       // its scalar is that above the lower knot
    double length;            // in world units

    glm::dvec4 optics(double t) const {
        const double share = width > 0 ? std::clamp(value(field, t).w / width, 0., 1.) : 0;
        return glm::mix(lower, upper, share);
    }

    // The optical depth, by Gauss' rule with two points, which is exact for cubics.
    double depth(double from, double to) const {
        const double middle = 0.5 * (from + to), offset = 0.5 * (to - from) / std::sqrt(3.);
        const double sum = optics(middle - offset).w + optics(middle + offset).w;
        return 0.5 * (to - from) * length * sum;
    }
};

// Sums up what a ray sees, front to back (docs/numerics.md, sections 1 and 10).
class PlainRay {
  public:
    glm::dvec3 color{0};
    double depth = 0;
    double error = 0;        // of the worst channel
    std::int64_t shown = 0;  // number of segments with extinction

    PlainRay(const Scene& scene, const View::Ray& ray, const std::vector<Segment>& segments)
        : knots_(scene.transfer_function->knots()), world_per_z_(glm::length(ray.direction)) {
        for (const TransferKnot& knot : knots_)
            brightest_ = std::max(brightest_, largest(knot.optics.color));
        if (scene.lighting) take(*scene.lighting, -unit_vector(ray.direction));
        for (const Segment& segment : segments) length_ += segment.seen.to - segment.seen.from;
        for (const Segment& segment : segments) {
            const double before = depth;
            const std::vector<double> ends = cuts(segment.field);
            for (std::size_t i = 1; i < ends.size(); ++i) add(segment, ends[i - 1], ends[i]);
            if (depth > before) ++shown;
        }
    }

  private:
    static constexpr double tolerance = 1e-7;  // of a ray, as a share of full scale
    static constexpr double rounding = 1e-14;  // of one quadrature
    static constexpr int most_halvings = 60;

    struct RayLight {
        glm::dvec3 direction, halfway, color;
    };

    void take(const Lighting& lighting, const glm::dvec3& eye) {
        lighting_ = &lighting;
        glm::dvec3 sum(0);
        for (const Light& light : lighting.lights) {
            const glm::dvec3 to_light = light.direction ? unit_vector(*light.direction) : eye;
            const glm::dvec3 between = to_light + eye;
            const bool opposite = glm::length(between) < 1e-12;
            lights_.push_back(
                {to_light, opposite ? glm::dvec3(0) : glm::normalize(between), light.color});
            sum += light.color;
        }
        brightest_ *= 1 + lighting.ambient + lighting.diffuse * largest(sum);
        brightest_ += lighting.specular * largest(sum);
    }

    // Gives 0, where the scalar turns or meets a knot, where light has a kink because the gradient
    // is perpendicular to it or to its halfway vector, and 1.
    std::vector<double> cuts(const Cubic<Field>& field) const {
        const auto along = [&](const Field& v) {
            return Cubic<double>{glm::dot(field[0], v), glm::dot(field[1], v),
                                 glm::dot(field[2], v), glm::dot(field[3], v)};
        };
        const Cubic<double> scalar = along({0, 0, 0, 1});
        const std::vector<double> turns = monotone_ends(scalar);
        std::vector<double> found = turns;
        for (const TransferKnot& knot : knots_) append_crossings(scalar, knot.value, turns, found);
        for (const RayLight& light : lights_) {
            for (const glm::dvec3& v : {light.direction, light.halfway})
                append_crossings(along({v, 0}), 0, monotone_ends(along({v, 0})), found);
        }
        std::sort(found.begin(), found.end());
        return found;
    }

    // Adds a part of a segment. The scalar in its middle says between which knots it lies.
    void add(const Segment& segment, double from, double to) {
        if (!(from < to)) return;
        const double scalar = value(segment.field, 0.5 * (from + to)).w;
        auto upper = std::ranges::upper_bound(knots_, scalar, {}, &TransferKnot::value);
        auto lower = upper == knots_.begin() ? upper : upper - 1;
        if (upper == knots_.end()) upper = lower;
        const auto optics = [](const TransferKnot& knot) {
            return glm::dvec4(knot.optics.color, std::min(knot.optics.extinction, 1e200));
        };
        Cubic<Field> field = segment.field;
        field[0].w -= lower->value;
        add({optics(*lower), optics(*upper), upper->value - lower->value,
             around(field, from, to - from),
             (to - from) * (segment.seen.to - segment.seen.from) * world_per_z_},
            0, 1, 0);
    }

    // The colour at a place, lit as docs/numerics.md, section 10, says.
    glm::dvec3 shade(const Piece& piece, double t) const {
        const glm::dvec3 c(piece.optics(t)), gradient(value(piece.field, t));
        const double steepness = glm::length(gradient);
        if (lights_.empty() || steepness == 0) return c;
        const double w = 1 / (1 + std::pow(*lighting_->smallest_gradient / steepness, 2));
        glm::dvec3 lit = lighting_->ambient * c;
        for (const auto& [direction, halfway, light] : lights_) {
            const double cosine = std::abs(glm::dot(gradient, direction)) / steepness;
            const double shine = std::abs(glm::dot(gradient, halfway)) / steepness;
            lit += light * (c * lighting_->diffuse * cosine +
                            lighting_->specular * std::pow(shine, lighting_->power));
        }
        return glm::mix(c, lit, w);
    }

    // Integrates the colour that is seen, by Gauss' rule with six points.
    glm::dvec3 gauss(const Piece& piece, double from, double to, double in_front) const {
        constexpr double nodes[] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
        constexpr double weights[] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
        const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
        glm::dvec3 sum(0);
        for (int i = 0; i < 6; ++i) {
            const double t = middle + (i < 3 ? half : -half) * nodes[i % 3];
            const double seen = std::exp(-in_front - piece.depth(from, t));
            sum +=
                half * weights[i % 3] * seen * piece.length * piece.optics(t).w * shade(piece, t);
        }
        return sum;
    }

    // Adds a part of a piece, in halves unless it is hidden, or two quadratures agree. These see
    // all of a part that is thin, and where the gradient turns little (by Taylor's series).
    void add(const Piece& piece, double from, double to, int halvings) {
        const double middle = 0.5 * (from + to), thickness = piece.depth(from, to);
        const double opacity = std::exp(-depth) * -std::expm1(-thickness);
        const double share = (to - from) * piece.length / (length_ * world_per_z_);
        const double allowed = 0.5 * tolerance * (opacity + share) + rounding * brightest_;
        const Cubic<Field> near = around(piece.field, middle, 0.5 * (to - from));
        const auto length = [&](std::size_t i) { return glm::length(glm::dvec3(near[i])); };
        const bool straight =
            lights_.empty() || length(1) + length(2) + length(3) <= 0.5 * length(0);
        // Any colour is between 0 and the brightest.
        glm::dvec3 seen = opacity * shade(piece, middle);
        double off = opacity * brightest_;
        if (off > allowed && thickness <= 1 && straight) {
            const double behind = depth + piece.depth(from, middle);
            seen = gauss(piece, from, middle, depth) + gauss(piece, middle, to, behind);
            off = largest(glm::abs(seen - gauss(piece, from, to, depth)));
        }
        if (off > allowed && halvings < most_halvings) {
            add(piece, from, middle, halvings + 1);
            return add(piece, middle, to, halvings + 1);
        }
        color += seen;
        error += off;
        depth += thickness;
    }

    std::span<const TransferKnot> knots_;
    double world_per_z_;
    double brightest_ = 1;  // no colour and no opacity is more
    double length_ = 0;     // of all segments, along z
    const Lighting* lighting_ = nullptr;
    std::vector<RayLight> lights_;
};

template <typename Data>
PlainPicture trace_data(const Scene& scene, const Data& data) {
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
            const PlainRay found(scene, ray, data.meet(ray, seen));
            double* const pixel = picture.image.pixel(column, static_cast<int>(row));
            for (int c = 0; c < 3; ++c) pixel[c] = found.color[c];
            pixel[3] = -std::expm1(-found.depth);
            const std::lock_guard lock(adding);
            picture.error_estimate = std::max(picture.error_estimate, found.error);
            picture.segments += found.shown;
        }
        progress.advance();
    });
    return picture;
}

}  // namespace

PlainPicture trace_plainly(const Scene& scene, const Volume& volume) {
    PlainPicture picture = trace_data(scene, PlainVolume(volume));
    check_unchanged(volume);
    return picture;
}

PlainPicture trace_plainly(const Scene& scene, const SceneMesh& mesh) {
    return trace_data(scene, PlainMesh(mesh));
}

}  // namespace lamina
