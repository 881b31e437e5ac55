// SPDX-License-Identifier: Apache-2.0
#include "meshing/volume_mesh.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <unordered_set>
#include <utility>

#include "base/arithmetic.h"
#include "base/client.h"
#include "base/error.h"
#include "base/parallel.h"

namespace lamina {
namespace {

// The six tets of a cell (corners x + 2y + 4z): one for each path along edges from 0 to 7.
constexpr std::array<Tet, 6> cell_tets{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

std::int64_t kuhn_tet_count(const TrilinearField& field) {
    return std::int64_t{6} * field.cell_count(0) * field.cell_count(1) * field.cell_count(2);
}

void check_size(const TrilinearField& field, std::int64_t max_tets) {
    const std::int64_t tets = kuhn_tet_count(field);
    if (tets > max_tets) {
        fail(
            "the Kuhn split of {} x {} x {} cells has {} tets, more than the {} allowed "
            "(--max-tets, mesh.max_tets)",
            field.cell_count(0), field.cell_count(1), field.cell_count(2), tets, max_tets);
    }
    std::int64_t points = 1;
    for (int axis = 0; axis < 3; ++axis)
        points *= static_cast<std::int64_t>(field.planes(axis).size());
    if (points > std::numeric_limits<std::int32_t>::max()) {
        fail("the Kuhn split has {} points: expected fewer than 2^31", points);
    }
}

constexpr double finest_lattice = 256;  // places for points along an axis, per sample
// Points nearer to the box's surface than this share of their tet's extent are moved onto it, since
// flat tets between them and the surface would remain otherwise.
constexpr double surface_share = 0.125;
// Number of tets that a point adds, a little above the average (6.77 for random points).
constexpr double tets_per_point = 7;
constexpr std::int64_t tets_per_task = 16;
// Share of max_tets below which the tets still allowed are not worth a round.
constexpr double worth_a_round = 0.005;

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

// The points of the mesh, all different, with the field's values. shrink() removes the last ones.
class Points {
  public:
    explicit Points(const TrilinearField& field) : field_(field) {}

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

// A tet and its sorted corners, by which the next round recognises it.
struct NamedTet {
    Tet corners;
    std::int32_t index;
};

std::vector<NamedTet> by_name(const std::vector<Tet>& tets) {
    std::vector<NamedTet> names(tets.size());
    parallel_for(std::ssize(tets), 4096, [&](std::int64_t i) {
        names[i] = {tets[i], static_cast<std::int32_t>(i)};
        std::sort(names[i].corners.begin(), names[i].corners.end());
    });
    parallel_sort(names.begin(), names.end(),
                  [](const NamedTet& a, const NamedTet& b) { return a.corners < b.corners; });
    return names;
}

struct Round {
    DelaunayTets mesh;
    std::vector<NamedTet> names;   // sorted by corners
    std::vector<TetError> errors;  // error of each tet
};

double volume_of(const std::array<glm::dvec3, 4>& p) {
    return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6;
}

// Tells whether `point` is in a positive tet's circumsphere. Rounded: it only guides a choice.
bool in_sphere(const std::array<glm::dvec3, 4>& p, const glm::dvec3& point) {
    const glm::dvec3 a = p[0] - point, b = p[1] - point, c = p[2] - point, d = p[3] - point;
    const glm::dvec3 ab = glm::cross(a, b), cd = glm::cross(c, d);
    const double determinant = glm::dot(a, a) * glm::dot(b, cd) - glm::dot(b, b) * glm::dot(a, cd) +
                               glm::dot(c, c) * glm::dot(d, ab) - glm::dot(d, d) * glm::dot(c, ab);
    return determinant > 0;
}

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

    MeshData run(MeshReport& report) {
        begin();
        DelaunayTets first = tetrahedralize();
        if (std::ssize(first.tets) > max_tets_) {
            fail(
                "the box alone takes {} tets, more than the {} allowed (--max-tets, mesh.max_tets)",
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

  private:
    void begin() {
        const glm::dvec3 box[2] = {field_.min(), field_.max()};
        for (int corner = 0; corner < 8; ++corner) {
            points_.add({box[corner & 1].x, box[(corner >> 1) & 1].y, box[corner >> 2].z});
        }
    }

    // Adds points and makes a new mesh. Returns false at the end.
    bool refine(MeshReport& report) {
        const std::vector<std::int32_t> worst = violators();
        report.within_tolerance = worst.empty();
        report.stopped_by_max_tets = false;
        if (worst.empty()) return false;
        const auto tets = std::ssize(round_.mesh.tets);
        const double room = static_cast<double>(max_tets_ - tets);
        report.stopped_by_max_tets = room < worth_a_round * static_cast<double>(max_tets_);
        if (report.stopped_by_max_tets) return false;

        const std::size_t before = points_.size();
        add_points(worst, static_cast<std::size_t>(std::max(1.0, room / tets_per_point)));
        while (points_.size() > before) {
            DelaunayTets mesh = tetrahedralize();
            if (std::ssize(mesh.tets) <= max_tets_) {
                accept(std::move(mesh));
                return true;
            }
            report.stopped_by_max_tets = true;
            points_.shrink(before + (points_.size() - before) / 2);
        }
        return false;
    }

    // Makes the Delaunay tets, and checks them, because they come from another program.
    DelaunayTets tetrahedralize() const {
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

    // Makes `mesh` the current one, and measures those tets that the previous mesh did not have.
    void accept(DelaunayTets mesh) {
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
                          std::ssize(fresh));
        parallel_for(std::ssize(fresh), tets_per_task, [&](std::int64_t i) {
            next.errors[fresh[i]] = measured(next.mesh.tets[fresh[i]], ErrorGoal::decide);
            progress.advance();
        });
        round_ = std::move(next);
    }

    TetError measured(const Tet& tet, ErrorGoal goal) const {
        return error_.measure(points_.corners(tet), points_.values(tet), tolerance_, goal);
    }

    // Returns the tets over the tolerance, the worst first.
    std::vector<std::int32_t> violators() const {
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

    // Adds points, at most one in each cavity: the tets with a new point in their circumspheres.
    void add_points(const std::vector<std::int32_t>& violators, std::size_t most) {
        destroyed_.assign(round_.mesh.tets.size(), false);
        const std::size_t before = points_.size();
        for (const std::int32_t tet : violators) {
            if (points_.size() - before == most) break;
            if (!destroyed_[tet]) add_point_in(tet);
        }
    }

    // Adds a point in the tet's circumsphere, at a free place on the coarsest lattice that has one:
    // points at samples, and halfway between them, serve neighbouring tets, too.
    bool add_point_in(std::int32_t tet) {
        const auto corners = points_.corners(round_.mesh.tets[tet]);
        for (double per_sample = 1; per_sample <= finest_lattice; per_sample *= 2) {
            const glm::dvec3 place = snapped(round_.errors[tet].place, per_sample);
            if (add_point(tet, onto_surface(place, corners))) return true;
        }
        const glm::dvec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
        return add_point(tet, onto_surface(snapped(middle, finest_lattice), corners));
    }

    bool add_point(std::int32_t tet, const glm::dvec3& place) {
        if (!in_sphere(points_.corners(round_.mesh.tets[tet]), place) || !points_.add(place)) {
            return false;
        }
        destroy_cavity(tet, place);
        return true;
    }

    void destroy_cavity(std::int32_t tet, const glm::dvec3& point) {
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

    glm::dvec3 onto_surface(glm::dvec3 place, const std::array<glm::dvec3, 4>& corners) const {
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

    // Measures tets that ErrorGoal::decide left without a bound. Returns the largest of all bounds.
    double final_error() {
        const std::vector<std::int32_t> open = violators();
        parallel_for(std::ssize(open), 32, [&](std::int64_t i) {
            round_.errors[open[i]] = measured(round_.mesh.tets[open[i]], ErrorGoal::bound);
        });
        double largest = 0;
        for (const TetError& error : round_.errors) largest = std::max(largest, error.bound);
        return largest;
    }

    const TrilinearField& field_;
    const InterpolationError& error_;
    const Delaunay& delaunay_;
    std::int64_t max_tets_;
    double tolerance_;  // in the data's units
    Points points_;
    Round round_;
    std::vector<bool> destroyed_;  // marks tets that new points of this round destroy
    std::vector<std::int32_t> cavity_;
    int rounds_ = 0;
};

// Tolerance, as a share of the range, to which the error of a Kuhn mesh is measured.
constexpr double kuhn_error_floor = 1e-4;

}  // namespace

MeshData make_kuhn_mesh(const TrilinearField& field, std::int64_t max_tets) {
    check_size(field, max_tets);
    const std::int32_t nx = field.cell_count(0) + 1, ny = field.cell_count(1) + 1;
    const std::int32_t nz = field.cell_count(2) + 1;
    const std::int32_t row = nx, slice = nx * ny;
    MeshData mesh;
    mesh.points.resize(static_cast<std::size_t>(slice) * nz);
    mesh.point_scalars = {{mesh_scalar_name, std::vector<double>(mesh.points.size())}};
    parallel_for(std::int64_t{ny} * nz, 64, [&](std::int64_t line) {
        const auto y = static_cast<std::int32_t>(line % ny);
        const auto z = static_cast<std::int32_t>(line / ny);
        for (std::int32_t x = 0; x < nx; ++x) {
            const auto point = static_cast<std::size_t>(line * nx + x);
            mesh.points[point] = {field.planes(0)[x], field.planes(1)[y], field.planes(2)[z]};
            mesh.point_scalars[0].values[point] = field.at_plane({x, y, z});
        }
    });

    mesh.tets.resize(static_cast<std::size_t>(kuhn_tet_count(field)));
    parallel_for(std::int64_t{ny - 1} * (nz - 1), 64, [&](std::int64_t line) {
        const auto y = static_cast<std::int32_t>(line % (ny - 1));
        const auto z = static_cast<std::int32_t>(line / (ny - 1));
        auto next = mesh.tets.begin() + 6 * line * (nx - 1);
        for (std::int32_t x = 0; x < nx - 1; ++x) {
            const std::int32_t first = z * slice + y * row + x;
            for (Tet tet : cell_tets) {
                for (std::int32_t& corner : tet) {
                    corner =
                        first + (corner & 1) + ((corner >> 1) & 1) * row + (corner >> 2) * slice;
                }
                *next++ = tet;
            }
        }
    });
    return mesh;
}

MeshData make_adaptive_mesh(const TrilinearField& field, const InterpolationError& error,
                            const Delaunay& delaunay, const MeshSettings& settings,
                            MeshReport& report) {
    return Refinement(field, error, delaunay, settings).run(report);
}

void place_in_world(MeshData& mesh, const Grid& grid) {
    for (glm::dvec3& point : mesh.points) point = grid.to_world(point);
    const bool mirrored = glm::dot(glm::cross(grid.step[0], grid.step[1]), grid.step[2]) < 0;
    if (!mirrored) return;
    for (Tet& tet : mesh.tets) std::swap(tet[2], tet[3]);
}

MeshData make_volume_mesh(const Volume& volume, const MeshSettings& settings,
                          const TransferFunction* transfer_function, MeshReport& report) {
    if (volume.grid().lookup == VolumeLookup::nearest) {
        fail(
            "mesh: found a volume with \"lookup\": \"nearest\", expected \"linear\": fields of "
            "tets "
            "are linear, not constant in each voxel");
    }
    const TrilinearField field(volume);
    const CellRanges ranges(field);
    const InterpolationError error(field, ranges, transfer_function);
    report = {};
    report.kuhn_tets = kuhn_tet_count(field);
    report.range = field.range().hi - field.range().lo;
    MeshData mesh;
    if (settings.kuhn) {
        mesh = make_kuhn_mesh(field, settings.max_tets);
        report.error = error.largest(mesh.points, mesh.point_scalars[0].values, mesh.tets,
                                     kuhn_error_floor * report.range);
        report.within_tolerance = report.error <= settings.tolerance * report.range;
    } else {
        const auto program = require_tetrahedralizer();
        const auto delaunay = [&](std::span<const glm::dvec3> points) {
            return delaunay_by_process(program, points);
        };
        mesh = make_adaptive_mesh(field, error, delaunay, settings, report);
    }
    report.points = std::ssize(mesh.points);
    report.tets = std::ssize(mesh.tets);
    place_in_world(mesh, volume.grid());
    return mesh;
}

}  // namespace lamina
