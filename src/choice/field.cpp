// SPDX-License-Identifier: Apache-2.0
#include "choice/field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "choice/shown_cells.h"
#include "facts/mesh_facts.h"
#include "facts/volume_facts.h"
#include "mesh/predicates.h"
#include "optics/pieces.h"
#include "scene/clip.h"
#include "volume/labels.h"
#include "volume/sample_source.h"
#include "volume/volume_store.h"

namespace lamina {

namespace {

// Returns the counted values of a volume with their numbers as weights.
std::vector<WeightedValue> weighted(const ValueCounts& counted, SampleType type) {
    const double lowest =
        type == SampleType::int16 ? double{std::numeric_limits<std::int16_t>::min()} : 0;
    std::vector<WeightedValue> values;
    for (std::size_t code = 0; code < counted.codes.size(); ++code) {
        if (counted.codes[code] > 0)
            values.push_back(
                {static_cast<double>(code) + lowest, static_cast<double>(counted.codes[code])});
    }
    for (const float value : counted.some) values.push_back({value, 1});
    return values;
}

// Returns how many samples of a box weighted() takes of a volume.
double counted_in(const SampleBox& box, const Volume& volume) {
    if (volume.type() != SampleType::float32) return static_cast<double>(box.count());
    const auto& size = volume.grid().size;
    std::int64_t count = 0;
    const std::int64_t step = sample_step(volume.grid());
    for (std::int64_t i = 0; i < volume.grid().sample_count(); i += step) {
        const std::array<std::int64_t, 3> at{i % size[0], i / size[0] % size[1],
                                             i / (size[0] * size[1])};
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
            inside = inside && at[axis] >= box.first[axis] &&
                     at[axis] < box.first[axis] + box.size[axis];
        count += inside ? 1 : 0;
    }
    return static_cast<double>(count);
}

// Returns how often values occur in a border, of those that weighted() takes of a volume.
std::map<double, double> counted_in(const ConstantBorder& border, const Volume& volume) {
    const bool all = volume.type() != SampleType::float32;
    const std::int64_t step = all ? 1 : sample_step(volume.grid());
    std::map<double, double> counted;
    for (const BorderLayers& layers : border.layers) {
        double alike = counted_in(layers.samples, volume);
        for (const BorderLayers::Odd& odd : layers.odd) {
            if (odd.index % step != 0) continue;
            --alike;
            if (std::isfinite(odd.value)) ++counted[odd.value];
        }
        counted[layers.value] += alike;
    }
    return counted;
}

// Lowers the weights of values.
void take_away(std::vector<WeightedValue>& values, std::map<double, double> away) {
    for (WeightedValue& one : values) {
        const auto found = away.find(one.value);
        if (found == away.end()) continue;
        const double less = std::min(one.weight, found->second);
        one.weight -= less;
        found->second -= less;
    }
}

constexpr std::size_t most_tets = std::size_t{1} << 19;  // more tets are sampled evenly

// Barycentric coordinates of a four-point quadrature exact for quadratics (Hammer and Stroud 1956).
constexpr double near_corner = 0.58541019662496845, near_others = 0.13819660112501051;

// Returns six times the volume of a tet, in units of the mesh's diagonal cubed.
double volume_of(const TetMesh& mesh, const Tet& tet, double diagonal) {
    const auto at = [&](std::size_t corner) {
        return mesh.points()[static_cast<std::size_t>(tet[corner])] / diagonal;
    };
    const glm::dvec3 origin = at(0);
    return std::abs(glm::dot(at(1) - origin, glm::cross(at(2) - origin, at(3) - origin)));
}

// Weight of a value that marks missing data if only some tets of a mesh are sampled, in units of
// the mesh's diagonal cubed: more than 0, but too small to change any share.
constexpr double smallest_weight = 1e-30;

// Returns the values at points that lie so far from all others that they mark missing data.
std::vector<double> markers_of(const SceneMesh& mesh) {
    std::vector<WeightedValue> at_points;
    at_points.reserve(mesh.scalar.values.size());
    for (const double value : mesh.scalar.values) {
        if (std::isfinite(value)) at_points.push_back({value, 1});
    }
    return find_markers(ValueDistribution(std::move(at_points)));
}

// Returns the optical depth of a segment in a tet.
double depth_of(const TransferFunction& transfer_function, const MeshFacts::Segment& segment) {
    double sum = 0;
    for_each_linear_piece(
        transfer_function.knots(), segment.front, segment.back, [&](const LinearPiece& piece) {
            const double mean = (piece.at_from.extinction + piece.at_to.extinction) / 2;
            sum += segment.front == segment.back
                       ? mean
                       : mean * ((piece.to - piece.from) / (segment.back - segment.front));
        });
    return sum * segment.length;
}

double distance(const HalfSpace& half, const glm::dvec3& point) {
    return glm::dot(half.normal, point - half.point) / glm::length(half.normal);
}

// Cuts a segment, so that no end is farther than `slack` beyond the half-space. Returns false if
// all of it is.
bool cut(const HalfSpace& half, double slack, glm::dvec3& a, glm::dvec3& b) {
    const double at_a = distance(half, a) + slack, at_b = distance(half, b) + slack;
    if (at_a < 0 && at_b < 0) return false;
    if (at_a < 0) a += at_a / (at_a - at_b) * (b - a);
    if (at_b < 0) b += at_b / (at_b - at_a) * (a - b);
    return true;
}

// Returns what the half-space keeps of hull_of_shown_cells(): pairs of points, the ends of rows of
// cells. A row at most a cell beyond the plane belongs to cells that the plane crosses; its points
// are moved onto the plane, where a plane along the grid's axes cuts these cells. `cells`: the edge
// of what the rows consist of.
std::vector<glm::dvec3> kept_of(const std::vector<glm::dvec3>& pairs, const HalfSpace& half,
                                const Grid& grid, double cells) {
    const glm::dvec3 normal = glm::normalize(half.normal);
    double slack = 0;
    for (const glm::dvec3& step : grid.step) slack += cells * std::abs(glm::dot(normal, step));
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i + 1 < pairs.size(); i += 2) {
        glm::dvec3 ends[2] = {pairs[i], pairs[i + 1]};
        if (!cut(half, slack, ends[0], ends[1])) continue;
        for (const glm::dvec3& end : ends)
            kept.push_back(end - std::min(distance(half, end), 0.) * normal);
    }
    return kept;
}

// Calls visit(begin, end) for the samples of the row (y, z) along x that have a say in what the
// planes keep, if there are any: a sample reaches over its voxel or, if the field is interpolated,
// to its neighbours.
template <typename Sample, typename Visit>
void visit_kept(const SampleWindow<Sample>& window, const Grid& grid, std::int64_t y,
                std::int64_t z, std::span<const IndexPlane> planes, const Visit& visit) {
    const double samples = grid.lookup == VolumeLookup::nearest ? 0.5 : 1;
    // Samples of the row between which no plane cuts all away that one reaches: the distance of the
    // farthest corner is linear along the row.
    double first = 0, last = static_cast<double>(grid.size[0] - 1);
    for (const IndexPlane& plane : planes) {
        const glm::dvec3 n = plane.normal, reach = samples * glm::abs(n);
        const double at =
            plane.distance(glm::dvec3(0, y, z) + grid.first_sample()) + reach.x + reach.y + reach.z;
        if (n.x > 0) first = std::max(first, std::floor(-at / n.x) + 1);
        if (n.x < 0) last = std::min(last, std::ceil(-at / n.x) - 1);
        if (n.x == 0 && at <= 0) last = -1;
    }
    if (first > last) return;
    const Sample* const row = window.row(y, z);
    visit(row + static_cast<std::int64_t>(first), row + static_cast<std::int64_t>(last) + 1);
}

// Tells for each code of whole samples, from the type's lowest one on, whether a voxel with it is
// kept.
template <typename Sample>
std::vector<char> kept_codes(const Volume& volume, std::span<const IndexPlane> planes) {
    constexpr int lowest = std::numeric_limits<Sample>::min();
    constexpr std::size_t count = std::size_t{1} << 8 * sizeof(Sample);
    const Grid& grid = volume.grid();
    const SampleWindow<Sample> window{{{0, 0, 0}, grid.size},
                                      static_cast<const Sample*>(volume.data())};
    std::vector<char> kept(count);
    std::mutex adding;
    parallel_for(grid.size[2], 1, [&](std::int64_t z) {
        std::vector<char> here(count);
        for (std::int64_t y = 0; y < grid.size[1]; ++y) {
            visit_kept(window, grid, y, z, planes, [&](const Sample* at, const Sample* end) {
                for (; at != end; ++at) here[static_cast<std::size_t>(*at - lowest)] = 1;
            });
        }
        const std::scoped_lock lock(adding);
        for (std::size_t i = 0; i < count; ++i) kept[i] |= here[i];
    });
    return kept;
}

// Returns the range of the finite samples that have a say in what the planes keep.
template <typename Sample>
ValueRange kept_samples(const Volume& volume, std::span<const IndexPlane> planes) {
    const Grid& grid = volume.grid();
    const std::int64_t slices =
        std::max<std::int64_t>(1, most_read / (grid.size[0] * grid.size[1]));
    ValueRange kept;
    std::mutex adding;
    parallel_for((grid.size[2] + slices - 1) / slices, 1, [&](std::int64_t block) {
        SampleBox box{{0, 0, block * slices}, grid.size};
        box.size[2] = std::min(slices, grid.size[2] - box.first[2]);
        Sample lo = std::numeric_limits<Sample>::max(), hi = std::numeric_limits<Sample>::lowest();
        visit_window<Sample>(volume, box, [&](const SampleWindow<Sample>& window) {
            for (std::int64_t i = 0; i < box.size[1] * box.size[2]; ++i) {
                const std::int64_t y = i % box.size[1], z = box.first[2] + i / box.size[1];
                visit_kept(window, grid, y, z, planes, [&](const Sample* at, const Sample* end) {
                    for (; at != end; ++at) {
                        if (!std::isfinite(static_cast<double>(*at))) continue;
                        lo = std::min(lo, *at);
                        hi = std::max(hi, *at);
                    }
                });
            }
        });
        if (lo > hi) return;
        const std::scoped_lock lock(adding);
        kept = joined(kept, {static_cast<double>(lo), static_cast<double>(hi)});
    });
    return kept;
}

// Returns the value at all corners of a volume; nothing if they differ.
std::optional<double> corner_value(const Volume& volume) {
    const std::array<std::int64_t, 3>& size = volume.grid().size;
    std::optional<double> found;
    for (unsigned corner = 0; corner < 8; ++corner) {
        SampleBox one{{0, 0, 0}, {1, 1, 1}};
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((corner >> axis & 1) != 0) one.first[axis] = size[axis] - 1;
        const double value = with_sample_type(volume.type(), [&](auto zero) {
            return visit_window<decltype(zero)>(volume, one, [&](const auto& window) {
                return static_cast<double>(window.at(one.first[0], one.first[1], one.first[2]));
            });
        });
        if (found && *found != value) return std::nullopt;
        found = value;
    }
    return found;
}

// Tells whether all samples at the outer faces of a volume have a value; an axis of one sample has
// no faces.
bool faces_have(const Volume& volume, double value) {
    const SampleBox whole{{0, 0, 0}, volume.grid().size};
    const auto has_value = [&](const SampleBox& face) {
        return with_sample_type(volume.type(), [&](auto zero) {
            using T = decltype(zero);
            return visit_window<T>(volume, face, [&](const SampleWindow<T>& window) {
                for (std::int64_t z = face.first[2]; z < face.first[2] + face.size[2]; ++z) {
                    for (std::int64_t y = face.first[1]; y < face.first[1] + face.size[1]; ++y) {
                        const T* const row = window.row(y, z) + face.first[0] - window.box.first[0];
                        const auto odd = [&](T sample) { return double(sample) != value; };
                        if (std::any_of(row, row + face.size[0], odd)) return false;
                    }
                }
                return true;
            });
        });
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::int64_t at : {std::int64_t{0}, whole.size[axis] - 1}) {
            SampleBox face = whole;
            face.first[axis] = at;
            face.size[axis] = 1;
            if (whole.size[axis] > 1 && !has_value(face)) return false;
        }
    }
    return true;
}

}  // namespace

double VolumeField::spacing() const {
    const Grid& grid = volume_.grid();
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] > 1) smallest = std::min(smallest, glm::length(grid.step[axis]));
    }
    return smallest;
}

// Whole numbers in square slices, whose distance is another one than that of their rows, and that
// are as large in millimetres as a part of a body, are most probably CT or MR.
bool VolumeField::axial_slices() const {
    constexpr double least_body = 50, least_slice = 100, most_slice = 700;  // mm
    const Grid& grid = volume_.grid();
    if (!grid.unit.empty() && grid.unit != "mm") return false;
    std::array<double, 3> distance, length;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(grid.step[axis][static_cast<int>(axis)] > 0)) return false;  // not along the world's
        distance[axis] = glm::length(grid.step[axis]);
        length[axis] = distance[axis] * static_cast<double>(grid.size[axis]);
    }
    return grid.axes == WorldAxes::unnamed && whole_numbers() && grid.size[0] == grid.size[1] &&
           distance[0] == distance[1] && distance[2] != distance[0] && length[0] >= least_slice &&
           length[0] <= most_slice && length[2] >= least_body;
}

std::optional<SliceAxes> VolumeField::slice() const {
    const Grid& grid = volume_.grid();
    if (std::ranges::count(grid.size, 1) != 1) return std::nullopt;
    const auto thin = static_cast<std::size_t>(std::ranges::find(grid.size, 1) - grid.size.begin());
    const std::size_t first = thin == 0 ? 1 : 0, second = thin == 2 ? 1 : 2;
    const glm::dvec3 across = glm::normalize(glm::cross(grid.step[first], grid.step[second]));
    const auto axis = static_cast<int>(thin);
    const double steps = grid.index_max()[axis] - grid.index_min()[axis];
    return SliceAxes{grid.step[first], grid.step[second],
                     steps * std::abs(glm::dot(across, grid.step[thin]))};
}

bool VolumeField::lies_in_pieces() const {
    if (!in_pieces_) {
        const LabelSigns::Verdict verdict = label_signs(volume_).verdict;
        in_pieces_ =
            verdict == LabelSigns::Verdict::labels || verdict == LabelSigns::Verdict::scattered;
    }
    return *in_pieces_;
}

std::optional<double> VolumeField::value_around() const {
    const std::optional<double> found = corner_value(volume_);
    if (!found || labels() == nullptr) return found;
    const bool is_large = volume_.grid().sample_count() > large_volume;
    return is_large || !faces_have(volume_, *found) ? std::nullopt : found;
}

const VolumeLabels* VolumeField::labels() const {
    static const VolumeLabels nothing;
    if (!whole_numbers() || volume_.grid().lookup == VolumeLookup::linear) return nullptr;
    return volume_.labels() ? volume_.labels().get() : &nothing;
}

SampleBox VolumeField::inside() const {
    return border_ ? border_->inside : SampleBox{{0, 0, 0}, volume_.grid().size};
}

ValueDistribution VolumeField::distribution() const {
    std::vector<WeightedValue> values =
        weighted(values_ != nullptr ? *values_ : count_values(volume_), volume_.type());
    if (border_) take_away(values, counted_in(*border_, volume_));
    return ValueDistribution(std::move(values));
}

std::optional<BorderlessField> VolumeField::without_border() const {
    if (volume_.grid().lookup == VolumeLookup::nearest) return std::nullopt;
    std::optional<ConstantBorder> border = find_constant_border(volume_, bricks_.whole);
    if (!border || lies_in_pieces()) return std::nullopt;  // labels around others are no border
    BorderlessField result;
    for (const BorderLayers& layers : border->layers) {
        const glm::dvec3 inward = volume_.grid().step[layers.axis];
        glm::dvec3 first_inside(0);
        first_inside[static_cast<int>(layers.axis)] = static_cast<double>(
            layers.samples.first[layers.axis] + (layers.upper ? -1 : layers.width));
        result.sides.push_back({layers.value,
                                layers.behind,
                                layers.width,
                                {volume_.grid().to_world(first_inside),
                                 glm::normalize(layers.upper ? glm::dvec3(0) - inward : inward)}});
    }
    auto inner = std::make_unique<VolumeField>(volume_, bricks_, values_, std::move(border));
    inner->in_pieces_ = in_pieces_;
    result.field = std::move(inner);
    return result;
}

std::optional<std::vector<double>> VolumeField::kept_values(const Clip& clip) const {
    if (!whole_numbers() || !volume_.in_memory()) return std::nullopt;
    const std::vector<IndexPlane> planes = index_planes(clip, volume_.grid());
    std::vector<double> values;
    const auto add = [&](const std::vector<char>& kept, int lowest) {
        for (std::size_t code = 0; code < kept.size(); ++code)
            if (kept[code] != 0) values.push_back(static_cast<double>(code) + lowest);
    };
    if (volume_.type() == SampleType::uint8)
        add(kept_codes<std::uint8_t>(volume_, planes), 0);
    else if (volume_.type() == SampleType::uint16)
        add(kept_codes<std::uint16_t>(volume_, planes), 0);
    else
        add(kept_codes<std::int16_t>(volume_, planes), std::numeric_limits<std::int16_t>::min());
    return values;
}

ValueRange VolumeField::kept_range(const Clip& clip) const {
    if (clip.keeps_all() || volume_.grid().sample_count() > large_volume) return range();
    const std::vector<IndexPlane> planes = index_planes(clip, volume_.grid());
    return with_sample_type(
        volume_.type(), [&](auto zero) { return kept_samples<decltype(zero)>(volume_, planes); });
}

std::vector<glm::dvec3> VolumeField::shown_points(const TransferFunction& transfer_function,
                                                  double least, const Clip& clip) const {
    const Grid& grid = volume_.grid();
    const double cells =
        grid.sample_count() > large_volume ? static_cast<double>(MinMaxBricks::edge) : 1;
    const auto shows = [&](const ValueRange& range) {
        return transfer_function.max_extinction(range.lo, range.hi) > least;
    };
    std::vector<glm::dvec3> points = hull_of_shown_cells(volume_, bricks_, shows, inside());
    for (const HalfSpace& half : half_spaces(clip)) points = kept_of(points, half, grid, cells);
    return points;
}

std::array<glm::dvec3, 8> VolumeField::corners() const {
    const Grid& grid = volume_.grid();
    glm::dvec3 lo = grid.index_min(), hi = grid.index_max();
    for (const BorderLayers& layers : border_ ? border_->layers : std::vector<BorderLayers>()) {
        const auto axis = static_cast<int>(layers.axis);
        (layers.upper ? hi : lo)[axis] = static_cast<double>(layers.samples.first[layers.axis] +
                                                             (layers.upper ? -1 : layers.width));
    }
    std::array<glm::dvec3, 8> corners = box_corners(lo, hi);
    for (glm::dvec3& corner : corners) corner = grid.to_world(corner);
    return corners;
}

std::vector<double> VolumeField::optical_depths(const Scene& scene) const {
    Facts facts;
    facts.grid = volume_.grid();
    facts.clip = index_planes(scene.clip, facts.grid);
    measure_view(scene, facts);
    const bool large = volume_.grid().sample_count() > large_volume;
    const RaySampling sampling = large ? RaySampling{256, 256} : RaySampling{};
    std::vector<double> depths;
    for (const ScalarRays::Ray& ray : sample_rays(scene, volume_, facts, &bricks_, sampling).rays)
        depths.push_back(ray.optical_depths.back());
    return depths;
}

double MeshField::spacing() const {
    const auto points = mesh_.mesh.points();
    double sum = 0;
    for (const Tet& tet : mesh_.mesh.tets()) {
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                sum += glm::distance(points[static_cast<std::size_t>(tet[i])],
                                     points[static_cast<std::size_t>(tet[j])]);
            }
        }
    }
    return sum / (6 * static_cast<double>(mesh_.mesh.tets().size()));
}

ValueDistribution MeshField::distribution() const {
    const auto tets = mesh_.mesh.tets();
    const TetMesh::Bounds& bounds = mesh_.mesh.bounds();
    const double diagonal = glm::distance(bounds.min, bounds.max);
    const std::size_t step = tets.size() / most_tets + 1;
    const std::vector<double> markers = markers_of(mesh_);
    std::vector<WeightedValue> values;
    for (std::size_t i = 0; i < tets.size(); i += step) {
        const Tet& tet = tets[i];
        const ValueRange range = range_in(mesh_.scalar.values, tet);
        if (range.empty()) continue;
        const double weight = volume_of(mesh_.mesh, tet, diagonal);
        std::array<double, 4> at_corners;
        double sum = 0;
        bool marked = false;
        for (std::size_t k = 0; k < 4; ++k) {
            at_corners[k] = mesh_.scalar.values[static_cast<std::size_t>(tet[k])];
            sum += at_corners[k];
            marked = marked || std::ranges::count(markers, at_corners[k]) > 0;
        }
        for (const double value : at_corners) {
            const double inside = near_others * (sum - value) + near_corner * value;
            values.push_back({marked ? value : std::clamp(inside, range.lo, range.hi), weight});
        }
    }
    // The only corner with a marker may belong to a tet that is not sampled.
    if (step > 1) {
        for (const double marker : markers) values.push_back({marker, smallest_weight});
    }
    return ValueDistribution(std::move(values));
}

double MeshField::surface_outside(const ValueRange& range) const {
    double all = 0, outside = 0;
    for (const TetFace& face : mesh_.mesh.open_faces()) {
        const Tet& tet = mesh_.mesh.tets()[static_cast<std::size_t>(face.tet)];
        double share = 0;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const double value = mesh_.scalar.values[static_cast<std::size_t>(tet[corner])];
            if (corner != static_cast<std::size_t>(face.face) &&
                (value < range.lo || value > range.hi))
                share += 1. / 3;
        }
        const auto at = mesh_.mesh.corners(face);
        const double area = glm::length(glm::cross(at[1] - at[0], at[2] - at[0]));
        all += area;
        outside += share * area;
    }
    return all > 0 ? outside / all : 0;
}

const SceneMesh* MeshField::kept_by(const Clip& clip) const {
    if (clip != clip_) {
        const std::shared_ptr<const SceneMesh> whole(std::shared_ptr<const void>(), &mesh_);
        kept_ = clipped_mesh(whole, clip, false, "mesh");
        clip_ = clip;
    }
    return kept_.get();
}

ValueRange MeshField::kept_range(const Clip& clip) const {
    if (clip.keeps_all()) return range();
    const SceneMesh* const kept = kept_by(clip);
    return kept == nullptr ? ValueRange() : MeshField(*kept).range();
}

std::vector<glm::dvec3> MeshField::shown_points(const TransferFunction& transfer_function,
                                                double least, const Clip& clip) const {
    if (!clip.keeps_all()) {
        const SceneMesh* const kept = kept_by(clip);
        if (kept == nullptr) return {};
        return MeshField(*kept).shown_points(transfer_function, least);
    }
    const auto points = mesh_.mesh.points();
    std::vector<char> shown(points.size());
    for (const Tet& tet : mesh_.mesh.tets()) {
        const ValueRange range = range_in(mesh_.scalar.values, tet);
        if (range.empty() || !(transfer_function.max_extinction(range.lo, range.hi) > least))
            continue;
        for (const std::int32_t corner : tet) shown[static_cast<std::size_t>(corner)] = 1;
    }
    std::vector<glm::dvec3> found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (shown[i] != 0) found.push_back(points[i]);
    }
    return found;
}

std::array<glm::dvec3, 8> MeshField::corners() const {
    return box_corners(mesh_.mesh.bounds().min, mesh_.mesh.bounds().max);
}

std::vector<double> MeshField::optical_depths(const Scene& scene) const {
    if (!scene.clip.keeps_all()) {
        const SceneMesh* const kept = kept_by(scene.clip);
        if (kept == nullptr) return {};
        Scene whole = scene;
        whole.clip = {};
        return MeshField(*kept).optical_depths(whole);
    }
    std::vector<double> depths;
    for (const auto& ray : find_view_rays(scene, mesh_)) {
        double depth = 0;
        for (const MeshFacts::Segment& segment : ray)
            depth += depth_of(*scene.transfer_function, segment);
        depths.push_back(depth);
    }
    return depths;
}

std::optional<BorderlessField> Field::without_border() const {
    return std::nullopt;
}

bool Field::cut_away_by(const Clip& clip) const {
    if (clip.keeps_all()) return false;
    const auto box = corners();
    MeshData tets;
    tets.points.assign(box.begin(), box.end());
    tets.tets = {{0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}};
    return cut_mesh(std::move(tets), half_spaces(clip)).tets.empty();
}

double diagonal_of(const Field& field) {
    const auto corners = field.corners();
    return glm::distance(corners.front(), corners.back());
}

AnnotatedData annotated_data(const Field& field, const Annotations& wanted, const Clip& clip) {
    const VolumeLabels* const named = field.labels();
    const ValueRange kept_range = wanted.colorbar ? field.kept_range(clip) : field.range();
    AnnotatedData data{field.quantity(),
                       field.length_unit(),
                       field.axes(),
                       field.corners(),
                       kept_range.empty() ? field.range() : kept_range,
                       named != nullptr,
                       {}};
    if (named == nullptr || !wanted.labels) return data;
    const ValueDistribution values = field.distribution();
    auto next = named->list.begin();
    for (std::size_t i = 0; i < values.distinct(); ++i) {
        const double code = values.value(i);
        while (next != named->list.end() && next->code < code) ++next;
        if (next != named->list.end() && next->code == code)
            data.labels.push_back(*next);
        else
            data.labels.push_back({code, fmt::format("{:.0f}", code)});
    }
    if (clip.keeps_all()) return data;
    if (const auto kept = field.kept_values(clip)) {
        std::erase_if(data.labels, [&](const Label& label) {
            return !std::ranges::binary_search(*kept, label.code);
        });
    }
    return data;
}

}  // namespace lamina
