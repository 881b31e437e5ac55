// SPDX-License-Identifier: Apache-2.0
#include "mesh/face_matching.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/parallel.h"

namespace lamina {
namespace {

constexpr std::int64_t points_per_task = 1024;

// A face in the bucket of its least corner. `code` is 4 * tet + face.
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

// All faces. Those with least corner p are at start[p] .. start[p + 1] - 1.
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
            buckets.faces[next[static_cast<std::size_t>(least)]++] = {
                middle, largest, static_cast<std::uint32_t>(4 * tet + face)};
        }
    }
    return buckets;
}

// What one bucket adds to the counts.
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
    std::int32_t& across(const FaceKey& key) {
        return matching_.neighbors[static_cast<std::size_t>(key.tet())][key.face()];
    }
    std::int32_t opposite(const FaceKey& key) const {
        return tets_[static_cast<std::size_t>(key.tet())][key.face()];
    }
    // Tets with a common face and the same opposite corner are the same tet. They are marked only
    // at the face opposite their largest corner, in the bucket of their least one, so that no two
    // tasks write one mark.
    void mark_duplicates(std::span<const FaceKey> group) {
        std::vector<FaceKey> by_apex(group.begin(), group.end());
        std::sort(by_apex.begin(), by_apex.end(), [&](const FaceKey& a, const FaceKey& b) {
            return std::pair(opposite(a), a.code) < std::pair(opposite(b), b.code);
        });
        for (std::size_t i = 1; i < by_apex.size(); ++i) {
            const std::int32_t apex = opposite(by_apex[i]);
            const Tet& tet = tets_[static_cast<std::size_t>(by_apex[i].tet())];
            if (apex == opposite(by_apex[i - 1]) &&
                apex == *std::max_element(tet.begin(), tet.end()))
                duplicate_[static_cast<std::size_t>(by_apex[i].tet())] = 1;
        }
    }

    std::span<const Tet> tets_;
    FaceMatching& matching_;
    std::vector<char> duplicate_;
};

}  // namespace

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
            counts[static_cast<std::size_t>(task)].boundary += found.boundary;
            counts[static_cast<std::size_t>(task)].nonmanifold += found.nonmanifold;
        }
    });
    for (const BucketCounts& found : counts) {
        matching.boundary_faces += found.boundary;
        matching.nonmanifold_faces += found.nonmanifold;
    }
    matching.duplicates = matcher.duplicates();
    return matching;
}

}  // namespace lamina
