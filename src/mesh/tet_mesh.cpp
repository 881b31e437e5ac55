// SPDX-License-Identifier: Apache-2.0
#include "mesh/tet_mesh.h"

#include <atomic>
#include <bit>
#include <cassert>
#include <numeric>
#include <tuple>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include "base/error.h"
#include "base/parallel.h"
#include "mesh/point_table.h"
#include "mesh/predicates.h"

namespace lamina {
namespace {

constexpr std::int64_t points_per_task = 1024;

// A face in FaceBuckets, by its two larger corners. code: 4 * tet + number of the face in the tet.
struct FaceKey {
    std::int32_t middle, largest;
    std::uint32_t code;
    std::int32_t tet() const { return static_cast<std::int32_t>(code >> 2); }
    std::size_t face() const { return code & 3; }
    bool same_face(const FaceKey& other) const {
        return middle == other.middle && largest == other.largest;
    }
    bool operator<(const FaceKey& other) const {
        return std::tie(middle, largest, code) < std::tie(other.middle, other.largest, other.code);
    }
};

std::array<std::int32_t, 3> ascending_corners(const Tet& tet, std::size_t face) {
    auto [a, b, c] = corners_of_face(tet, face);
    if (a > b) std::swap(a, b);
    if (b > c) std::swap(b, c);
    if (a > b) std::swap(a, b);
    return {a, b, c};
}

// All faces, sorted by their least corner p: those of p are at start[p] .. start[p + 1] - 1.
struct FaceBuckets {
    std::vector<std::uint32_t> start;
    std::vector<FaceKey> faces;
};

FaceBuckets fill_buckets(std::span<const Tet> tets, std::size_t point_count) {
    FaceBuckets buckets;
    buckets.start.assign(point_count + 1, 0);
    for (const Tet& tet : tets) {
        for (std::size_t face = 0; face < 4; ++face)
            ++buckets.start[static_cast<std::size_t>(ascending_corners(tet, face)[0]) + 1];
    }
    std::partial_sum(buckets.start.begin(), buckets.start.end(), buckets.start.begin());
    std::vector<std::uint32_t> next(buckets.start.begin(), buckets.start.end() - 1);
    buckets.faces.resize(4 * tets.size());
    for (std::size_t tet = 0; tet < tets.size(); ++tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            const auto [least, middle, largest] = ascending_corners(tets[tet], face);
            buckets.faces[next[least]++] = {middle, largest,
                                            static_cast<std::uint32_t>(4 * tet + face)};
        }
    }
    return buckets;
}

// The tet across each face, found by corner indices alone. Faces of three or more tets have none.
struct FaceMatching {
    std::vector<std::array<std::int32_t, 4>> neighbors;
    // Tets with the same corners as an earlier tet, ascending.
    std::vector<std::int32_t> duplicates;
    std::int64_t boundary_faces = 0;     // number of faces of one tet
    std::int64_t nonmanifold_faces = 0;  // number of faces of three or more tets
};

struct BucketCounts {
    std::int32_t boundary = 0, nonmanifold = 0;
};

class Matcher {
  public:
    Matcher(std::span<const Tet> tets, FaceMatching& matching)
        : tets_(tets), matching_(matching), duplicate_(tets.size(), 0) {}

    BucketCounts match(std::span<FaceKey> bucket) {
        BucketCounts counts;
        std::sort(bucket.begin(), bucket.end());
        for (std::size_t first = 0, end = 0; first < bucket.size(); first = end) {
            while (end < bucket.size() && bucket[end].same_face(bucket[first])) ++end;
            const std::span<const FaceKey> group = bucket.subspan(first, end - first);
            if (group.size() > 2 || (group.size() == 2 && opposite(group[0]) == opposite(group[1])))
                mark_duplicates(group);
            counts.boundary += group.size() == 1;
            counts.nonmanifold += group.size() > 2;
            if (group.size() != 2) continue;
            across(group[0]) = group[1].tet();
            across(group[1]) = group[0].tet();
        }
        return counts;
    }

    std::vector<std::int32_t> duplicates() const {
        std::vector<std::int32_t> marked;
        for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
            if (duplicate_[tet] != 0) marked.push_back(static_cast<std::int32_t>(tet));
        }
        return marked;
    }

  private:
    std::int32_t& across(const FaceKey& key) { return matching_.neighbors[key.tet()][key.face()]; }
    std::int32_t opposite(const FaceKey& key) const { return tets_[key.tet()][key.face()]; }
    // Marks tets that have the same corners as an earlier one. Each is marked only when its face
    // opposite its largest corner is matched, so no two tasks write one mark.
    void mark_duplicates(std::span<const FaceKey> group) {
        std::vector<FaceKey> by_apex(group.begin(), group.end());
        std::sort(by_apex.begin(), by_apex.end(), [&](const FaceKey& a, const FaceKey& b) {
            return std::pair(opposite(a), a.code) < std::pair(opposite(b), b.code);
        });
        for (std::size_t i = 1; i < by_apex.size(); ++i) {
            const std::int32_t apex = opposite(by_apex[i]);
            const Tet& tet = tets_[by_apex[i].tet()];
            if (apex == opposite(by_apex[i - 1]) &&
                apex == *std::max_element(tet.begin(), tet.end()))
                duplicate_[by_apex[i].tet()] = 1;
        }
    }

    std::span<const Tet> tets_;
    FaceMatching& matching_;
    std::vector<char> duplicate_;
};

constexpr std::int64_t grain = 4096;                     // tets per task
constexpr std::size_t most_tets = std::size_t{1} << 29;  // four faces each must fit 32 bits

// Limits coordinates, so that products of three of them are finite (mesh/predicates.h).
constexpr double largest_coordinate = 1e100;

bool usable(const glm::dvec3& p) {
    return std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate &&
           std::abs(p.z) <= largest_coordinate;  // false for NaN
}

bool repeats_corner(Tet corners) {
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) != corners.end();
}

// Tells, by corner order, whether two tets lie on opposite sides of `face` (its number in `tet`).
bool opposite_sides(const Tet& tet, std::size_t face, const Tet& other) {
    const auto [p, q, r] = corners_of_face(tet, face);
    std::size_t apex = 0;
    while (other[apex] == p || other[apex] == q || other[apex] == r) ++apex;
    const auto seen = corners_of_face(other, apex);
    const auto at = static_cast<std::size_t>(std::find(seen.begin(), seen.end(), p) - seen.begin());
    return seen[(at + 1) % 3] == r;
}

void turn(Tet& tet, std::array<std::int32_t, 4>& neighbors) {
    std::swap(tet[2], tet[3]);
    std::swap(neighbors[2], neighbors[3]);
}

struct Weighted {
    glm::dvec3 sum{0};  // gradient times six volumes
    double weight = 0;
};

// Returns a tet's gradient, weighted by six times its volume, with lengths in units of `unit`.
Weighted weighted_gradient(const TetMesh& mesh, std::span<const double> scalar, const Tet& tet,
                           double unit) {
    const auto point = [&](std::size_t i) { return mesh.points()[tet[i]]; };
    const auto value = [&](std::size_t i) { return scalar[tet[i]]; };
    const glm::dvec3 a = (point(1) - point(0)) / unit, b = (point(2) - point(0)) / unit,
                     c = (point(3) - point(0)) / unit;
    const glm::dvec3 bc = glm::cross(b, c);
    const double weight = glm::dot(a, bc);
    const glm::dvec3 sum = (value(1) - value(0)) * bc + (value(2) - value(0)) * glm::cross(c, a) +
                           (value(3) - value(0)) * glm::cross(a, b);
    // All tets are positively oriented, but the rounded volume of a nearly flat one may be <= 0.
    if (!(weight > 0) || !std::isfinite(sum.x + sum.y + sum.z)) return {};
    return {sum, weight};
}

// Finds the tets across all faces by sorting faces: 48 bytes a tet. A tet's corners must differ.
FaceMatching match_faces(std::span<const Tet> tets, std::size_t point_count) {
    FaceMatching matching;
    matching.neighbors.assign(tets.size(), {-1, -1, -1, -1});
    FaceBuckets buckets = fill_buckets(tets, point_count);
    Matcher matcher(tets, matching);
    const auto points = static_cast<std::int64_t>(point_count);
    const std::int64_t tasks = (points + points_per_task - 1) / points_per_task;
    std::vector<BucketCounts> counts(static_cast<std::size_t>(tasks));
    parallel_for(tasks, 1, [&](std::int64_t task) {
        const std::int64_t end = std::min(points, (task + 1) * points_per_task);
        for (auto point = static_cast<std::size_t>(task * points_per_task);
             point < static_cast<std::size_t>(end); ++point) {
            const std::uint32_t from = buckets.start[point], to = buckets.start[point + 1];
            const BucketCounts found =
                matcher.match(std::span(buckets.faces).subspan(from, to - from));
            counts[task].boundary += found.boundary;
            counts[task].nonmanifold += found.nonmanifold;
        }
    });
    for (const BucketCounts& found : counts) {
        matching.boundary_faces += found.boundary;
        matching.nonmanifold_faces += found.nonmanifold;
    }
    matching.duplicates = matcher.duplicates();
    return matching;
}

}  // namespace

TetMesh::TetMesh(MeshData data, const std::string& name)
    : points_(std::move(data.points)),
      tets_(std::move(data.tets)),
      point_scalars_(std::move(data.point_scalars)),
      cell_scalars_(std::move(data.cell_scalars)) {
    findings_.cells = data.cells;
    findings_.tets_read = std::ssize(tets_);
    check_corners(name);
    drop_repeated_corners(name);
    check_points(name);
    // Meshes of cells that share no points have a point for each tet or two (quadratic cells),
    // others one for five or six. With so many, copies are looked for at once, so that faces are
    // matched only once.
    const bool cells_apart = points_.size() >= tets_.size() / 2;
    if (!cells_apart) find_neighbors();
    const bool joined = find_copies();
    if (joined) drop_repeated_corners(name);
    if (joined || cells_apart) find_neighbors();
    orient();
    orient_flat();
    cut_folded_faces();
    list_open_faces();
}

std::array<glm::dvec3, 3> TetMesh::corners(const TetFace& face) const {
    const auto [a, b, c] = corners_of_face(tets_[face.tet], face.face);
    return {points_[a], points_[b], points_[c]};
}

std::int32_t TetMesh::corner_at(std::int32_t tet, std::int32_t point) const {
    const Tet& corners = tets_[tet];
    std::size_t i = 0;
    while (i < 3 && place(corners[i]) != place(point)) ++i;
    return corners[i];
}

void TetMesh::check_corners(const std::string& name) const {
    if (tets_.empty()) fail("{}: found no tetrahedra, expected at least one", name);
    if (tets_.size() >= most_tets)
        fail("{}: found {} tets, expected fewer than {}", name, tets_.size(), most_tets);
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        for (const std::int32_t corner : tets_[tet]) {
            if (corner < 0 || static_cast<std::size_t>(corner) >= points_.size())
                fail("{}: tet {} has corner {}, expected 0 to {}", name, tet, corner,
                     std::ssize(points_) - 1);
        }
    }
}

void TetMesh::check_points(const std::string& name) {
    std::vector<char> used(points_.size(), 0);
    for (const Tet& tet : tets_) {
        for (const std::int32_t corner : tet) used[corner] = 1;
    }
    bounds_ = {glm::dvec3(INFINITY), glm::dvec3(-INFINITY)};
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (used[i] == 0) {
            ++findings_.unused_points;
            continue;
        }
        const glm::dvec3& p = points_[i];
        if (!usable(p))
            fail("{}: point {} is ({}, {}, {}), expected finite numbers up to 1e100", name, i, p.x,
                 p.y, p.z);
        bounds_.min = glm::min(bounds_.min, p);
        bounds_.max = glm::max(bounds_.max, p);
    }
}

void TetMesh::drop(const std::vector<char>& dropped) {
    const auto compact = [&](auto& items) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (dropped[i] == 0) items[kept++] = items[i];
        }
        items.resize(kept);
    };
    compact(tets_);
    for (MeshScalar& scalar : cell_scalars_) compact(scalar.values);
}

void TetMesh::drop_repeated_corners(const std::string& name) {
    std::vector<char> dropped(tets_.size(), 0);
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        if (!repeats_corner(place(tets_[tet]))) continue;
        dropped[tet] = 1;
        ++findings_.repeated_corners;
    }
    findings_.degenerate = findings_.repeated_corners;
    if (findings_.repeated_corners > 0) drop(dropped);
    if (tets_.empty()) fail("{}: all {} tets repeat a corner", name, findings_.tets_read);
}

// Finds the tets across all faces, and drops duplicates.
void TetMesh::find_neighbors() {
    const auto match = [&] {
        if (!has_copies()) return match_faces(tets_, points_.size());
        std::vector<Tet> at_places;
        at_places.reserve(tets_.size());
        for (const Tet& tet : tets_) at_places.push_back(place(tet));
        return match_faces(at_places, points_.size());
    };
    FaceMatching matching = match();
    if (!matching.duplicates.empty()) {
        findings_.duplicates += std::ssize(matching.duplicates);
        std::vector<char> dropped(tets_.size(), 0);
        for (const std::int32_t tet : matching.duplicates) dropped[tet] = 1;
        drop(dropped);
        matching = match();
    }
    neighbors_ = std::move(matching.neighbors);
    findings_.boundary_faces = matching.boundary_faces;
    findings_.nonmanifold_faces = matching.nonmanifold_faces;
}

// Finds copies of points on open faces (on all faces if neighbours are not known yet), and tells
// whether there are any. Other points need none: each of their faces has its two tets.
bool TetMesh::find_copies() {
    std::vector<char> open(points_.size(), 0);
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            if (!neighbors_.empty() && neighbors_[tet][face] != no_neighbor) continue;
            for (const std::int32_t corner : corners_of_face(tets_[tet], face)) open[corner] = 1;
        }
    }
    PointTable table(points_);
    table.reserve(static_cast<std::size_t>(std::ranges::count(open, 1)));
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (open[i] == 0) continue;
        const auto point = static_cast<std::int32_t>(i);
        const std::int32_t first = table.add(point);
        if (first == point) continue;
        if (places_.empty()) {
            places_.resize(points_.size());
            std::iota(places_.begin(), places_.end(), 0);
        }
        places_[i] = first;
        ++findings_.copies;
    }
    return has_copies();
}

void TetMesh::orient() {
    std::vector<char> flat(tets_.size(), 0);
    std::atomic<std::int64_t> inverted{0};
    parallel_for(std::ssize(tets_), grain, [&](std::size_t i) {
        const auto at = [&](std::size_t k) { return points_[tets_[i][k]]; };
        const int sign = orientation(at(0), at(1), at(2), at(3));
        flat[i] = sign == 0;
        if (sign >= 0) return;
        turn(tets_[i], neighbors_[i]);
        inverted.fetch_add(1, std::memory_order_relaxed);
    });
    findings_.inverted = inverted;
    for (std::size_t tet = 0; tet < flat.size(); ++tet) {
        if (flat[tet] != 0) flat_.push_back(static_cast<std::int32_t>(tet));
    }
    findings_.degenerate += std::ssize(flat_);
}

// Orients flat tets, which have no orientation of their own, so that they agree with a neighbour.
void TetMesh::orient_flat() {
    std::vector<char> open(tets_.size(), 0);
    for (const std::int32_t tet : flat_) open[tet] = 1;
    std::vector<std::int32_t> waiting = flat_;
    for (bool progress = true; progress && !waiting.empty();) {
        std::vector<std::int32_t> left;
        for (const std::int32_t index : waiting) {
            const auto tet = static_cast<std::size_t>(index);
            std::size_t face = 0;
            const auto oriented = [&](std::int32_t other) {
                return other != no_neighbor && open[other] == 0;
            };
            while (face < 4 && !oriented(neighbors_[tet][face])) ++face;
            if (face == 4) {
                left.push_back(index);
                continue;
            }
            const Tet other = place(tets_[neighbors_[tet][face]]);
            if (!opposite_sides(place(tets_[tet]), face, other)) turn(tets_[tet], neighbors_[tet]);
            open[tet] = 0;
        }
        progress = left.size() < waiting.size();
        waiting = std::move(left);
    }
}

void TetMesh::cut_folded_faces() {
    std::atomic<std::int64_t> folded{0};
    parallel_for(std::ssize(tets_), grain, [&](std::size_t tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            const std::int32_t other = neighbors_[tet][face];
            if (other == no_neighbor) continue;
            if (opposite_sides(place(tets_[tet]), face, place(tets_[other]))) continue;
            neighbors_[tet][face] = no_neighbor;
            folded.fetch_add(1, std::memory_order_relaxed);
        }
    });
    findings_.folded_faces = folded / 2;  // each was counted from both tets
}

void TetMesh::list_open_faces() {
    for (std::size_t tet = 0; tet < tets_.size(); ++tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            if (neighbors_[tet][face] == no_neighbor)
                open_faces_.push_back(
                    {static_cast<std::int32_t>(tet), static_cast<std::int32_t>(face)});
        }
    }
}

MeshScalar average_to_points(std::size_t point_count, std::span<const Tet> tets,
                             const MeshScalar& scalar, std::span<const std::int32_t> cell_of_tet) {
    assert(scalar.values.size() == tets.size());
    const auto finite =
        std::ranges::find_if(scalar.values, [](double value) { return std::isfinite(value); });
    const double elsewhere = finite == scalar.values.end() ? 0.0 : *finite;

    MeshScalar result{scalar.name, std::vector<double>(point_count, 0.0)};
    std::vector<std::int32_t> around(point_count, 0);
    // Calls use(point, tet) for each cell around each point once.
    const auto for_cells = [&](const auto& use) {
        const bool by_cells = cell_of_tet.size() == tets.size();  // a caller may have changed tets
        std::vector<std::int32_t> last(by_cells ? point_count : 0, -1);
        for (std::size_t i = 0; i < tets.size(); ++i) {
            for (const std::int32_t corner : tets[i]) {
                const auto point = static_cast<std::size_t>(corner);
                if (by_cells && std::exchange(last[point], cell_of_tet[i]) == cell_of_tet[i])
                    continue;
                use(point, i);
            }
        }
    };
    for_cells([&](std::size_t point, std::size_t) { ++around[point]; });
    for_cells([&](std::size_t point, std::size_t tet) {
        // Values are divided before they are added, so that no sum overflows.
        result.values[point] += scalar.values[tet] / around[point];
    });
    for (std::size_t point = 0; point < point_count; ++point) {
        if (around[point] == 0) result.values[point] = elsewhere;
    }
    return result;
}

const MeshScalar* only_array(const std::vector<MeshScalar>& cell_scalars) {
    if (cell_scalars.empty()) return nullptr;
    const MeshScalar& first = cell_scalars.front();
    const bool others = std::ranges::any_of(cell_scalars, [&](const MeshScalar& scalar) {
        return scalar.name != first.name && scalar.name != first.name + ".x" &&
               scalar.name != first.name + ".y" && scalar.name != first.name + ".z";
    });
    return others ? nullptr : &first;
}

std::vector<glm::dvec3> point_gradients(const TetMesh& mesh, std::span<const double> scalar) {
    const double unit = glm::distance(mesh.bounds().min, mesh.bounds().max);
    const std::vector<std::int32_t> equal = equal_points(mesh, scalar);
    const auto one_of = [&](std::size_t point) { return equal.empty() ? point : equal[point]; };
    std::vector<Weighted> points(mesh.points().size());
    for (const Tet& tet : mesh.tets()) {
        const Weighted one = weighted_gradient(mesh, scalar, tet, unit);
        if (!(one.weight > 0)) continue;
        for (const std::int32_t corner : tet) {
            Weighted& point = points[one_of(corner)];
            point.sum += one.sum;
            point.weight += one.weight;
        }
    }
    std::vector<glm::dvec3> gradients;
    gradients.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Weighted& point = points[one_of(i)];
        gradients.push_back(point.weight > 0 ? point.sum / point.weight / unit : glm::dvec3(0));
    }
    return gradients;
}

std::vector<std::int32_t> equal_points(const TetMesh& mesh, std::span<const double> scalar) {
    if (!mesh.has_copies()) return {};
    // The points by place: those of place p are at start[p] .. start[p + 1] - 1.
    const auto places = mesh.places();
    std::vector<std::int32_t> start(places.size() + 1, 0), sorted(places.size());
    for (const std::int32_t place : places) ++start[place + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::int32_t> next(start.begin(), start.end() - 1);
    for (std::size_t i = 0; i < places.size(); ++i)
        sorted[next[places[i]]++] = static_cast<std::int32_t>(i);
    const auto value = [&](std::int32_t point) {  // -0 becomes 0, and each NaN is one value
        return std::bit_cast<std::uint64_t>(scalar[point] + 0.0);
    };
    constexpr double rounding = 1e-6;  // some 8 of float32's
    const auto are_equal = [&](std::int32_t a, std::int32_t b) {
        const double least = std::min(std::abs(scalar[a]), std::abs(scalar[b]));
        return value(a) == value(b) || std::abs(scalar[a] - scalar[b]) <= rounding * least;
    };
    std::vector<std::int32_t> equal(places.size());
    parallel_for(std::ssize(places), points_per_task, [&](std::size_t place) {
        const std::span copies(sorted.begin() + start[place], sorted.begin() + start[place + 1]);
        std::ranges::sort(copies, {}, [&](std::int32_t p) { return std::pair(value(p), p); });
        for (std::size_t i = 0, first = 0; i < copies.size(); ++i) {
            if (!are_equal(copies[i], copies[first])) first = i;
            equal[copies[i]] = copies[first];
        }
    });
    return equal;
}

std::int64_t count_jumps(const TetMesh& mesh, std::span<const double> scalar) {
    const std::vector<std::int32_t> equal = equal_points(mesh, scalar);
    if (equal.empty()) return 0;
    std::atomic<std::int64_t> jumps{0};
    parallel_for(std::ssize(mesh.tets()), grain, [&](std::int64_t tet) {
        for (std::size_t face = 0; face < 4; ++face) {
            const std::int32_t other = mesh.neighbors()[tet][face];
            if (other <= tet) continue;  // boundary, or counted from the other tet
            const auto corners = corners_of_face(mesh.tets()[tet], face);
            const bool jumps_here = std::ranges::any_of(corners, [&](std::int32_t corner) {
                return equal[corner] != equal[mesh.corner_at(other, corner)];
            });
            if (jumps_here) jumps.fetch_add(1, std::memory_order_relaxed);
        }
    });
    return jumps;
}

}  // namespace lamina
