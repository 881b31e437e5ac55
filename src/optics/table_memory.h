// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "lamina/transfer_function.h"

namespace lamina {

// A cache of the tables that were requested last, by content: transfer function and request. It
// keeps at most 8 tables and 1 GiB. Safe from any thread. Table must have byte_count().
template <typename Request, typename Table>
class TableMemory {
  public:
    // The table from the cache, or what `build(transfer_function, request)` returns.
    template <typename Build>
    std::shared_ptr<const Table> get(const TransferFunction& transfer_function,
                                     const Request& request, const Build& build) {
        std::vector<double> knots = numbers_of(transfer_function);
        if (auto table = find(knots, request)) return table;
        // The table is not built under the lock: the build runs on all cores and may execute a task
        // that waits for the lock.
        auto table = std::make_shared<const Table>(build(transfer_function, request));
        add({std::move(knots), request, table});
        return table;
    }

  private:
    static constexpr std::int64_t most_bytes = std::int64_t{1} << 30;
    static constexpr std::size_t most_tables = 8;

    struct Known {
        std::vector<double> knots;
        Request request;
        std::shared_ptr<const Table> table;
    };

    static std::vector<double> numbers_of(const TransferFunction& transfer_function) {
        std::vector<double> numbers;
        for (const TransferKnot& knot : transfer_function.knots()) {
            const OpticalProperties& optics = knot.optics;
            numbers.insert(numbers.end(), {knot.value, optics.color.r, optics.color.g,
                                           optics.color.b, optics.extinction});
        }
        return numbers;
    }

    std::shared_ptr<const Table> find(const std::vector<double>& knots, const Request& request) {
        const std::lock_guard lock(mutex_);
        const auto found = std::ranges::find_if(known_, [&](const Known& known) {
            return known.request == request && known.knots == knots;
        });
        if (found == known_.end()) return nullptr;
        known_.splice(known_.begin(), known_, found);
        return known_.front().table;
    }

    void add(Known latest) {
        const std::lock_guard lock(mutex_);
        known_.push_front(std::move(latest));
        std::int64_t bytes = 0;
        std::size_t kept = 0;
        for (const Known& known : known_) {
            bytes += known.table->byte_count();
            if (bytes > most_bytes || kept == most_tables) break;
            ++kept;
        }
        while (known_.size() > kept) known_.pop_back();
    }

    std::mutex mutex_;
    std::list<Known> known_;
};

}  // namespace lamina
