// SPDX-License-Identifier: Apache-2.0
#include "meshing/adaptive_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <unordered_set>
#include <vector>

#include "base/arithmetic.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "meshing/volume_mesh.h"

namespace lamina {
namespace {

constexpr double finest_lattice = 256;  // places for points per sample
// Distance from the box's surface, as a share of its tet's extent, at which a point is moved onto
// the surface. Otherwise the flat tets between the two would stay.
constexpr double surface_share = 0.125;
constexpr double tets_per_point = 7;  // estimate, above the average (6.77 for random points)
constexpr std::int64_t tets_per_task = 16;
constexpr double worth_a_round = 0.005;  // share of max_tets; refinement ends if less is left

struct PlaceHash {
    std::size_t operator()(const std::array<std::int64_t, 3>& place) const {
        std::uint64_t hash = 0;
        for (const std::int64_t coordinate : place) {
            hash = (hash ^ static_cast<std::uint64_t>(coordinate)) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

glm::dvec3 snapped(const glm::dvec3& place, double per_sample) {
    return glm::floor(place * per_sample + 0.5) / per_sample;
}

// The points so far. The last ones can be taken back.
class Points {
  public:
    explicit Points(const TrilinearField& field) : field_(field) {}

    // Adds a point. Returns false if it is there already.
    bool add(const glm::dvec3& point) {
        if (!places_.insert(place_of(point)).second) return false;
        points_.push_back(point);
        values_.push_back(field_.at(point));
        return true;
    }
    void shrink(std::size_t count) {
        while (points_.size() > count) {
            places_.erase(place_of(points_.back()));
            points_.pop_back();
            values_.pop_back();
        }
    }
    std::size_t size() const { return points_.size(); }
    const std::vector<glm::dvec3>& points() const { return points_; }
    const std::vector<double>& values() const { return values_; }
    std::array<glm::dvec3, 4> corners(const Tet& tet) const {
        return {points_[tet[0]], points_[tet[1]], points_[tet[2]], points_[tet[3]]};
    }
    std::array<double, 4> values(const Tet& tet) const {
        return {values_[tet[0]], values_[tet[1]], values_[tet[2]], values_[tet[3]]};
    }

  private:
    static std::array<std::int64_t, 3> place_of(const glm::dvec3& point) {
        return {std::llround(point.x * finest_lattice), std::llround(point.y * finest_lattice),
                std::llround(point.z * finest_lattice)};
    }
    const TrilinearField& field_;
    std::vector<glm::dvec3> points_;
    std::vector<double> values_;
    std::unordered_set<std::array<std::int64_t, 3>, PlaceHash> places_;
};

// A tet named by its sorted corners, so that the next round recognises it.
struct NamedTet {
    Tet corners;
    std::int32_t index;
};

std::vector<NamedTet> by_name(const std::vector<Tet>& tets) {
    std::vector<NamedTet> names(tets.size());
    parallel_for(static_cast<std::int64_t>(tets.size()), 4096, [&](std::int64_t i) {
        names[i] = {tets[i], static_cast<std::int32_t>(i)};
        std::sort(names[i].corners.begin(), names[i].corners.end());
    });
    parallel_sort(names.begin(), names.end(),
                  [](const NamedTet& a, const NamedTet& b) { return a.corners < b.corners; });
    return names;
}

// The tets of one round, and what is known of their errors.
struct Round {
    DelaunayTets mesh;
    std::vector<NamedTet> names;
    std::vector<TetError> errors;
};

class Refinement {
  public:
    Refinement(const TrilinearField& field, const InterpolationError& error,
               const Delaunay& delaunay, const MeshSettings& settings)
        : field_(field),
          error_(error),
          delaunay_(delaunay),
          max_tets_(settings.max_tets),
          tolerance_(settings.tolerance * (field.range().hi - field.range().lo)),
          points_(field) {}

    MeshData run(MeshReport& report);

  private:
    void begin();
    bool refine(MeshReport& report);
    DelaunayTets tetrahedralize() const;
    void accept(DelaunayTets mesh);
    std::vector<std::int32_t> violators() const;
    void add_points(const std::vector<std::int32_t>& violators, std::size_t most);
    bool add_point_in(std::int32_t tet);
    bool add_point(std::int32_t tet, const glm::dvec3& place);
    void destroy_cavity(std::int32_t tet, const glm::dvec3& point);
    glm::dvec3 onto_surface(glm::dvec3 place, const std::array<glm::dvec3, 4>& corners) const;
    double final_error();

    const TrilinearField& field_;
    const InterpolationError& error_;
    const Delaunay& delaunay_;
    std::int64_t max_tets_;
    double tolerance_;  // in the data's units
    Points points_;
    Round round_;
    std::vector<bool> destroyed_;  // tets that points of this round destroy
    std::vector<std::int32_t> cavity_;
    int rounds_ = 0;
};

double volume_of(const std::array<glm::dvec3, 4>& p) {
    return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6;
}

// Tells whether `point` lies in the sphere through the corners of a positively oriented tet. It
// need not be exact, because it only guides a choice.
bool in_sphere(const std::array<glm::dvec3, 4>& p, const glm::dvec3& point) {
    const glm::dvec3 a = p[0] - point, b = p[1] - point, c = p[2] - point, d = p[3] - point;
    const glm::dvec3 ab = glm::cross(a, b), cd = glm::cross(c, d);
    const double determinant = glm::dot(a, a) * glm::dot(b, cd) - glm::dot(b, b) * glm::dot(a, cd) +
                               glm::dot(c, c) * glm::dot(d, ab) - glm::dot(d, d) * glm::dot(c, ab);
    return determinant > 0;
}

void Refinement::begin() {
    const glm::dvec3 box[2] = {field_.min(), field_.max()};
    for (int corner = 0; corner < 8; ++corner) {
        points_.add({box[corner & 1].x, box[(corner >> 1) & 1].y, box[corner >> 2].z});
    }
}

// Makes the tets and checks them, because they come from another program: all points are used, all
// tets are positive, and the box is filled.
DelaunayTets Refinement::tetrahedralize() const {
    DelaunayTets mesh = delaunay_(points_.points());
    std::vector<bool> used(points_.size(), false);
    CompensatedSum sum;
    std::int64_t bad = 0;
    for (const Tet& tet : mesh.tets) {
        const double part = volume_of(points_.corners(tet));
        if (!(part > 0)) ++bad;
        sum.add(part);
        for (const std::int32_t corner : tet) used[corner] = true;
    }
    const auto unused = std::count(used.begin(), used.end(), false);
    const glm::dvec3 size = field_.max() - field_.min();
    const double volume = sum.value(), expected = size.x * size.y * size.z;
    if (bad > 0 || unused > 0 || std::abs(volume - expected) > 1e-12 * expected) {
        fail(
            "the tetrahedra of {} points do not fill the box: volume {} of {}, {} tets without "
            "positive volume, {} points left out",
            points_.size(), volume, expected, bad, unused);
    }
    return mesh;
}

// Takes over a mesh and measures the tets that the round before did not have.
void Refinement::accept(DelaunayTets mesh) {
    Round next{std::move(mesh), {}, {}};
    next.names = by_name(next.mesh.tets);
    next.errors.resize(next.mesh.tets.size());
    std::vector<std::int32_t> fresh;
    auto known = round_.names.begin();
    for (const NamedTet& tet : next.names) {
        while (known != round_.names.end() && known->corners < tet.corners) ++known;
        if (known != round_.names.end() && known->corners == tet.corners) {
            next.errors[tet.index] = round_.errors[known->index];
        } else {
            fresh.push_back(tet.index);
        }
    }
    Progress progress(fmt::format("mesh, round {}: {} tets", ++rounds_, next.mesh.tets.size()),
                      static_cast<std::int64_t>(fresh.size()));
    const auto count = static_cast<std::int64_t>(fresh.size());
    parallel_for((count + tets_per_task - 1) / tets_per_task, 1, [&](std::int64_t task) {
        const std::int64_t first = task * tets_per_task;
        const std::int64_t end = std::min(count, first + tets_per_task);
        for (std::int64_t i = first; i < end; ++i) {
            const Tet& tet = next.mesh.tets[fresh[i]];
            next.errors[fresh[i]] = error_.measure(points_.corners(tet), points_.values(tet),
                                                   tolerance_, ErrorGoal::decide);
        }
        progress.advance(end - first);
    });
    round_ = std::move(next);
}

// Returns the tets over the tolerance, the worst first.
std::vector<std::int32_t> Refinement::violators() const {
    std::vector<std::int32_t> list;
    for (std::size_t i = 0; i < round_.errors.size(); ++i) {
        if (round_.errors[i].bound > tolerance_) list.push_back(static_cast<std::int32_t>(i));
    }
    std::sort(list.begin(), list.end(), [&](std::int32_t a, std::int32_t b) {
        const double of_a = round_.errors[a].found, of_b = round_.errors[b].found;
        return of_a != of_b ? of_a > of_b : a < b;
    });
    return list;
}

glm::dvec3 Refinement::onto_surface(glm::dvec3 place,
                                    const std::array<glm::dvec3, 4>& corners) const {
    const glm::dvec3 lo =
        glm::min(glm::min(corners[0], corners[1]), glm::min(corners[2], corners[3]));
    const glm::dvec3 hi =
        glm::max(glm::max(corners[0], corners[1]), glm::max(corners[2], corners[3]));
    for (int axis = 0; axis < 3; ++axis) {
        const double near = surface_share * (hi[axis] - lo[axis]);
        const double first = field_.min()[axis], last = field_.max()[axis];
        if (place[axis] - first < near) place[axis] = first;
        if (last - place[axis] < near) place[axis] = last;
    }
    return place;
}

// Adds a point near the place of the largest error: on the coarsest lattice that has a free place
// there which destroys the tet. Points at samples and halfway between them serve neighbouring tets,
// too, so fewer tets are needed than with points at the exact places.
bool Refinement::add_point_in(std::int32_t tet) {
    const auto corners = points_.corners(round_.mesh.tets[tet]);
    for (double per_sample = 1; per_sample <= finest_lattice; per_sample *= 2) {
        const glm::dvec3 place = snapped(round_.errors[tet].place, per_sample);
        if (add_point(tet, onto_surface(place, corners))) return true;
    }
    const glm::dvec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    return add_point(tet, onto_surface(snapped(middle, finest_lattice), corners));
}

bool Refinement::add_point(std::int32_t tet, const glm::dvec3& place) {
    if (!in_sphere(points_.corners(round_.mesh.tets[tet]), place) || !points_.add(place)) {
        return false;
    }
    destroy_cavity(tet, place);
    return true;
}

// Marks the tets that a new point removes from a Delaunay mesh: those whose spheres contain it.
void Refinement::destroy_cavity(std::int32_t tet, const glm::dvec3& point) {
    cavity_.assign(1, tet);
    destroyed_[tet] = true;
    while (!cavity_.empty()) {
        const std::int32_t at = cavity_.back();
        cavity_.pop_back();
        for (const std::int32_t neighbor : round_.mesh.neighbors[at]) {
            if (neighbor < 0 || destroyed_[neighbor]) continue;
            if (!in_sphere(points_.corners(round_.mesh.tets[neighbor]), point)) continue;
            destroyed_[neighbor] = true;
            cavity_.push_back(neighbor);
        }
    }
}

// Adds points so that no two of a round lie in one cavity: each goes where the field is known to
// need it.
void Refinement::add_points(const std::vector<std::int32_t>& violators, std::size_t most) {
    destroyed_.assign(round_.mesh.tets.size(), false);
    const std::size_t before = points_.size();
    for (const std::int32_t tet : violators) {
        if (points_.size() - before == most) break;
        if (!destroyed_[tet]) add_point_in(tet);
    }
}

// Does one round. Returns false if nothing is left to do, or if there is no room to do it.
bool Refinement::refine(MeshReport& report) {
    const std::vector<std::int32_t> worst = violators();
    report.within_tolerance = worst.empty();
    report.stopped_by_max_tets = false;
    if (worst.empty()) return false;
    const auto tets = static_cast<std::int64_t>(round_.mesh.tets.size());
    const double room = static_cast<double>(max_tets_ - tets);
    report.stopped_by_max_tets = room < worth_a_round * static_cast<double>(max_tets_);
    if (report.stopped_by_max_tets) return false;

    const std::size_t before = points_.size();
    add_points(worst, static_cast<std::size_t>(std::max(1.0, room / tets_per_point)));
    while (points_.size() > before) {
        DelaunayTets mesh = tetrahedralize();
        if (static_cast<std::int64_t>(mesh.tets.size()) <= max_tets_) {
            accept(std::move(mesh));
            return true;
        }
        report.stopped_by_max_tets = true;
        points_.shrink(before + (points_.size() - before) / 2);
    }
    return false;
}

// Measures the errors of tets over the tolerance: of these, decide() says only that they are.
double Refinement::final_error() {
    const std::vector<std::int32_t> open = violators();
    parallel_for(static_cast<std::int64_t>(open.size()), 32, [&](std::int64_t i) {
        const Tet& tet = round_.mesh.tets[open[i]];
        round_.errors[open[i]] =
            error_.measure(points_.corners(tet), points_.values(tet), tolerance_, ErrorGoal::bound);
    });
    double largest = 0;
    for (const TetError& error : round_.errors) largest = std::max(largest, error.bound);
    return largest;
}

MeshData Refinement::run(MeshReport& report) {
    begin();
    DelaunayTets first = tetrahedralize();
    if (static_cast<std::int64_t>(first.tets.size()) > max_tets_) {
        fail("the box alone takes {} tets, more than the {} allowed (--max-tets, mesh.max_tets)",
             first.tets.size(), max_tets_);
    }
    accept(std::move(first));
    while (refine(report)) {
    }
    report.rounds = rounds_;
    report.error = final_error();

    MeshData mesh;
    mesh.points = points_.points();
    mesh.tets = std::move(round_.mesh.tets);
    mesh.point_scalars = {{mesh_scalar_name, points_.values()}};
    return mesh;
}

}  // namespace

MeshData make_adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                            const Delaunay& delaunay, const MeshSettings& settings,
                            MeshReport& report) {
    return Refinement(field, error, delaunay, settings).run(report);
}

}  // namespace lamina
