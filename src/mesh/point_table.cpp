// SPDX-License-Identifier: Apache-2.0
#include "mesh/point_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "base/client.h"

namespace lamina {
namespace {

bool has_nan(const glm::dvec3& place) {
    return std::isnan(place.x) || std::isnan(place.y) || std::isnan(place.z);
}

bool is_finite(const glm::dvec3& place) {
    return std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
}

double distance_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);  // without underflow
}

// splitmix64 over the bits of each coordinate.
std::uint64_t hash_of(const glm::dvec3& place) {
    std::uint64_t hash = 0;
    for (const double coordinate : {place.x, place.y, place.z}) {
        hash +=
            std::bit_cast<std::uint64_t>(coordinate + 0.0) + 0x9e3779b97f4a7c15;  // -0 becomes 0
        hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9;
        hash = (hash ^ hash >> 27) * 0x94d049bb133111eb;
        hash ^= hash >> 31;
    }
    return hash;
}

}  // namespace

// Returns the slot that has this place, or the empty one to which it belongs.
std::size_t PointTable::slot_of(const glm::dvec3& place) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(place) & mask;
    while (slots_[slot] != 0 &&
           points_[static_cast<std::size_t>(std::abs(slots_[slot]) - 1)] != place) {
        slot = (slot + 1) & mask;
    }
    return slot;
}

void PointTable::grow(std::size_t slots) {
    std::vector<std::int32_t> old(slots, 0);
    old.swap(slots_);
    for (const std::int32_t entry : old) {
        if (entry == 0) continue;
        slots_[slot_of(points_[static_cast<std::size_t>(std::abs(entry) - 1)])] = entry;
    }
}

std::int32_t PointTable::add(std::int32_t point) {
    const glm::dvec3& place = points_[static_cast<std::size_t>(point)];
    if (has_nan(place)) return point;
    if (2 * (used_ + 1) > slots_.size()) grow(slots_.empty() ? 64 : 2 * slots_.size());
    std::int32_t& entry = slots_[slot_of(place)];
    used_ += entry == 0;
    entry = entry == 0 ? point + 1 : -std::abs(entry);
    return std::abs(entry) - 1;
}

void PointTable::reserve(std::size_t points) {
    const std::size_t wanted = 2 * (used_ + points);
    if (wanted > slots_.size()) grow(std::bit_ceil(std::max(wanted + 2, 2 * slots_.size())));
}

void PointPlaces::look() {
    const std::size_t looked_at = first_.size();
    table_.reserve(points_.size() - looked_at);
    for (std::size_t i = looked_at; i < points_.size(); ++i) {
        if ((i & 0xfffff) == 0) check_interrupt();
        first_.push_back(table_.add(static_cast<std::int32_t>(i)));
    }
}

void NearPlaces::take(std::span<glm::dvec3> points) {
    if (!(distance_ > 0)) return;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if ((i & 0xfffff) == 0) check_interrupt();
        if (!is_finite(points[i])) continue;
        const glm::dvec3 place = place_of(points[i]);
        if (place == points[i]) continue;
        ++moved_;
        farthest_ = std::max(farthest_, distance_between(place, points[i]));
        points[i] = place;
    }
}

glm::dvec3 NearPlaces::place_of(const glm::dvec3& point) {
    // The number of a cube along an axis: the whole part of a quotient. If doubles are coarser than
    // cubes, no other double is near, and the coordinate itself stands for the cube.
    const auto cube = [&](double coordinate) {
        const double quotient = coordinate / (4 * distance_);
        return std::abs(quotient) < 0x1p52 ? std::floor(quotient) : coordinate;
    };
    std::array<glm::dvec3, 2> ends;
    for (int axis = 0; axis < 3; ++axis) {
        ends[0][axis] = cube(point[axis] - distance_);
        ends[1][axis] = cube(point[axis] + distance_);
    }
    glm::dvec3 nearest = point;
    double least = distance_;
    bool found = false;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::size_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        if ((x == 1 && ends[0].x == ends[1].x) || (y == 1 && ends[0].y == ends[1].y) ||
            (z == 1 && ends[0].z == ends[1].z))
            continue;
        const auto first = cubes_.find(hash_of({ends[x].x, ends[y].y, ends[z].z}));
        std::int32_t at = first == cubes_.end() ? -1 : first->second;
        for (; at >= 0; at = places_[static_cast<std::size_t>(at)].before) {
            const glm::dvec3& place = places_[static_cast<std::size_t>(at)].at;
            const double away = distance_between(place, point);
            if (!(away <= least)) continue;
            nearest = place;
            least = away;
            found = true;
        }
    }
    if (found) return nearest;
    const auto [list, is_new] =
        cubes_.try_emplace(hash_of({cube(point.x), cube(point.y), cube(point.z)}), -1);
    places_.push_back({point, list->second});
    list->second = static_cast<std::int32_t>(places_.size() - 1);
    return point;
}

std::int32_t PointTable::find(const glm::dvec3& place) const {
    if (slots_.empty() || has_nan(place)) return -1;
    const std::int32_t entry = slots_[slot_of(place)];
    return entry > 0 ? entry - 1 : -1;
}

}  // namespace lamina
