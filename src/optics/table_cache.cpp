// SPDX-License-Identifier: Apache-2.0
#include "optics/table_cache.h"

#include <algorithm>
#include <utility>

#include "base/stage.h"

namespace lamina {
namespace {

std::vector<double> numbers_of(const TransferFunction& transfer_function) {
    std::vector<double> numbers;
    for (const TransferKnot& knot : transfer_function.knots()) {
        const OpticalProperties& optics = knot.optics;
        numbers.insert(numbers.end(), {knot.value, optics.color.r, optics.color.g, optics.color.b,
                                       optics.extinction});
    }
    return numbers;
}

std::int64_t memory_of(const PreintegrationTable& table) {
    return table.byte_count();
}
// Textures of some formats take less than the floats that they are made from.
std::int64_t memory_of(const SegmentTable& table) {
    return static_cast<std::int64_t>(table.texels.size() * sizeof(float));
}

}  // namespace

std::shared_ptr<const PreintegrationTable> TableCache::get(
    const TransferFunction& transfer_function, const PreintegrationRequest& request) {
    return get_or_build<PreintegrationTable>({numbers_of(transfer_function), request}, [&] {
        return build_preintegration_table(transfer_function, request);
    });
}

std::shared_ptr<const SegmentTable> TableCache::get(const TransferFunction& transfer_function,
                                                    const SegmentTableRequest& request) {
    return get_or_build<SegmentTable>({numbers_of(transfer_function), request}, [&] {
        return build_segment_table(transfer_function, request);
    });
}

// The table is not built under the lock: the build runs on all cores and may execute a task that
// waits for the lock. If two threads build one table, both get the one that was added first.
template <typename Table, typename Build>
std::shared_ptr<const Table> TableCache::get_or_build(Content content, const Build& build) {
    std::shared_ptr<const void> table = find(content);
    if (!table) {
        Stage building("table");
        const auto built = std::make_shared<const Table>(build());
        building.end();
        table = add(std::move(content), built, memory_of(*built));
    }
    return std::static_pointer_cast<const Table>(table);
}

std::shared_ptr<const void> TableCache::find(const Content& content) {
    const std::lock_guard lock(mutex_);
    return find_locked(content);
}

std::shared_ptr<const void> TableCache::add(Content content, std::shared_ptr<const void> table,
                                            std::int64_t bytes) {
    const std::lock_guard lock(mutex_);
    if (auto found = find_locked(content)) return found;
    known_.push_front({std::move(content), bytes, table, table});
    keep_newest();
    return table;
}

std::shared_ptr<const void> TableCache::find_locked(const Content& content) {
    const auto known = std::ranges::find(known_, content, &Known::content);
    if (known == known_.end()) return nullptr;
    std::shared_ptr<const void> table = known->table.lock();
    if (!table) {
        known_.erase(known);
        return nullptr;
    }
    known->kept = table;
    known_.splice(known_.begin(), known_, known);
    keep_newest();
    return table;
}

void TableCache::keep_newest() {
    std::int64_t bytes = 0;
    std::size_t count = 0;
    for (Known& known : known_) {
        bytes += known.bytes;
        ++count;
        if (bytes > most_bytes_ || count > most_tables) known.kept.reset();
    }
    std::erase_if(known_, [](const Known& known) { return known.table.expired(); });
}

}  // namespace lamina
