// SPDX-License-Identifier: Apache-2.0
// Pre-integration tables that several plans share.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "lamina/transfer_function.h"
#include "preintegration/preintegration_table.h"

namespace lamina {

// A plan's table. It follows from its request and from the transfer function, so plans are compared
// by the request (and the error) alone.
struct TablePlan {
    TableRequest request;  // lengths in the plan's units
    double error = 0;      // found error that it adds to the picture, in 1/255
    // Null if nothing looks it up; else of the request's kind.
    std::shared_ptr<const PreintegrationTable> built = nullptr;

    std::shared_ptr<const KnotTable> knot_table() const {
        return std::static_pointer_cast<const KnotTable>(built);
    }
    std::shared_ptr<const UniformTable> uniform_table() const {
        return std::static_pointer_cast<const UniformTable>(built);
    }

    friend bool operator==(const TablePlan& a, const TablePlan& b) {
        return a.request == b.request && a.error == b.error;
    }
};

// Builds tables, and finds them again by content: transfer function and request. The cache keeps
// the tables that were asked for last, at most 8 that take no more than `most_bytes` in all. A
// table that it keeps no longer is still found while someone else holds it. Safe from any thread.
class TableCache {
  public:
    static constexpr std::size_t most_tables = 8;

    explicit TableCache(std::int64_t most_bytes = std::int64_t{1} << 30)
        : most_bytes_(most_bytes) {}
    TableCache(const TableCache&) = delete;
    TableCache& operator=(const TableCache&) = delete;

    // Throws what build_table() throws. Requests that differ only in values on which their table
    // does not depend get one table: views that differ in the longest segment share a KnotTable of
    // one layer.
    std::shared_ptr<const PreintegrationTable> get(const TransferFunction& transfer_function,
                                                   const TableRequest& request);

  private:
    using TablePointer = std::shared_ptr<const PreintegrationTable>;

    struct Content {
        std::vector<double> knots;
        TableRequest request;
        friend bool operator==(const Content&, const Content&) = default;
    };
    struct Known {
        Content content;
        std::int64_t bytes;
        std::weak_ptr<const PreintegrationTable> table;
        TablePointer kept;  // null if only others hold it
    };

    TablePointer find(const Content& content);
    TablePointer add(Content content, TablePointer table);
    TablePointer find_locked(const Content& content);
    void keep_newest();

    std::int64_t most_bytes_;
    std::mutex mutex_;
    std::list<Known> known_;  // the one that was asked for last comes first
};

}  // namespace lamina
