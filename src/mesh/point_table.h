// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <glm/vec3.hpp>

namespace lamina {

// Finds points by their exact coordinates (0 equals -0; a point with NaN is never found).
class PointTable {
  public:
    // `points`: the points by index. The vector may grow, and must outlive this table.
    explicit PointTable(const std::vector<glm::dvec3>& points) : points_(points) {}

    void reserve(std::size_t points);  // prepares for so many more
    // Adds a point. Returns the first point that was added at its place: this one, or an earlier.
    std::int32_t add(std::int32_t point);
    // Returns the index of the only added point at this place, or -1, also if several were added.
    std::int32_t find(const glm::dvec3& place) const;

  private:
    std::size_t slot_of(const glm::dvec3& place) const;
    void grow(std::size_t slots);

    const std::vector<glm::dvec3>& points_;
    // A hash table with linear probing: its size is a power of two, at most half full. An entry is
    // 0 (empty), i + 1 (the point i), or -(i + 1) (several points, the first of which is i).
    std::vector<std::int32_t> slots_;
    std::size_t used_ = 0;  // entries that are not empty
};

// Knows the first point at each point's place, once it is asked to look at all points.
class PointPlaces {
  public:
    // `points`: as for PointTable.
    explicit PointPlaces(const std::vector<glm::dvec3>& points) : points_(points), table_(points) {}

    bool known() const { return !first_.empty(); }
    void look();  // looks at all points that there are now
    // Returns the first point at a point's place; the point itself before the first look().
    std::int32_t of(std::int32_t point) const {
        return known() ? first_[static_cast<std::size_t>(point)] : point;
    }
    const PointTable& table() const { return table_; }

  private:
    const std::vector<glm::dvec3>& points_;
    PointTable table_;
    std::vector<std::int32_t> first_;
};

// Makes points equal that are meant to be, but are not to the last bit: each point takes the place
// of the nearest earlier point that kept its own, if that is at most `distance` away. If `distance`
// is 0, all keep their own.
class NearPlaces {
  public:
    explicit NearPlaces(double distance) : distance_(distance) {}

    void take(std::span<glm::dvec3> points);

    std::int64_t moved() const { return moved_; }  // points that took another place
    double farthest() const { return farthest_; }  // the largest distance of these from it

  private:
    glm::dvec3 place_of(const glm::dvec3& point);

    double distance_;
    // Places in cubes of 4 distances: by the hash of a cube, the last place in it, whose `before`
    // is the one before. Places lie more than a distance apart, so that these lists are short.
    struct Place {
        glm::dvec3 at;
        std::int32_t before;
    };
    std::vector<Place> places_;
    std::unordered_map<std::uint64_t, std::int32_t> cubes_;
    std::int64_t moved_ = 0;
    double farthest_ = 0;
};

}  // namespace lamina
