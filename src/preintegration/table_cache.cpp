// SPDX-License-Identifier: Apache-2.0
#include "preintegration/preintegration_table.h"

#include <algorithm>
#include <utility>

#include "base/enum_words.h"
#include "base/profile.h"

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

// Returns the request with 0 for max_length if its table does not depend on that.
TableRequest without_idle_length(TableRequest request) {
    if (request.kind == TableKind::knots && request.length_layers == 1) request.max_length = 0;
    return request;
}

}  // namespace

std::shared_ptr<const PreintegrationTable> build_table(const TransferFunction& transfer_function,
                                                       const TableRequest& request) {
    switch (request.kind) {
        case TableKind::knots:
            return std::make_shared<const KnotTable>(transfer_function, request);
        case TableKind::uniform:
            return std::make_shared<const UniformTable>(transfer_function, request);
    }
    unreachable_enum();
}

// Builds the table without holding the lock: the build uses all cores, and a core may meanwhile run
// a task that waits for the lock. If two threads build one table, both get the one added first.
std::shared_ptr<const PreintegrationTable> TableCache::get(
    const TransferFunction& transfer_function, const TableRequest& request) {
    Content content{numbers_of(transfer_function), without_idle_length(request)};
    std::unique_lock lock(mutex_);
    if (auto table = find(content)) return table;
    lock.unlock();
    Stage building("table");
    auto table = build_table(transfer_function, content.request);
    building.end();
    lock.lock();
    if (auto found = find(content)) return found;
    known_.push_front({std::move(content), table->byte_count(), table, table});
    keep_newest();
    return table;
}

TableCache::TablePointer TableCache::find(const Content& content) {
    const auto known = std::ranges::find(known_, content, &Known::content);
    if (known == known_.end()) return nullptr;
    TablePointer table = known->table.lock();
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
