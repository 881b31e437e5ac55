// SPDX-License-Identifier: Apache-2.0
#include "mesh_files/point_table.h"

#include <bit>
#include <cmath>
#include <cstdlib>

#include "base/client.h"

namespace lamina {
namespace {

bool has_nan(const glm::dvec3& place) {
    return std::isnan(place.x) || std::isnan(place.y) || std::isnan(place.z);
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

// The slot that has this place, or the empty one where it belongs.
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

void PointTable::add(std::int32_t point) {
    const glm::dvec3& place = points_[static_cast<std::size_t>(point)];
    if (has_nan(place)) return;
    if (2 * (used_ + 1) > slots_.size()) grow(slots_.empty() ? 64 : 2 * slots_.size());
    std::int32_t& entry = slots_[slot_of(place)];
    used_ += entry == 0;
    entry = entry == 0 ? point + 1 : -std::abs(entry);
}

void PointTable::add_all() {
    if (2 * (used_ + points_.size()) > slots_.size())
        grow(std::bit_ceil(2 * (used_ + points_.size()) + 2));
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if ((i & 0xfffff) == 0) check_interrupt();
        add(static_cast<std::int32_t>(i));
    }
}

std::int32_t PointTable::find(const glm::dvec3& place) const {
    if (slots_.empty() || has_nan(place)) return -1;
    const std::int32_t entry = slots_[slot_of(place)];
    return entry > 0 ? entry - 1 : -1;
}

}  // namespace lamina
