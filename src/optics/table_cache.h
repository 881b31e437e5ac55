// SPDX-License-Identifier: Apache-2.0
// Pre-integration tables that several plans share.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <variant>
#include <vector>

#include "lamina/transfer_function.h"
#include "optics/preintegration_table.h"
#include "optics/segment_table.h"

namespace lamina {

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

    // Throws what the functions that build throw.
    std::shared_ptr<const PreintegrationTable> get(const TransferFunction& transfer_function,
                                                   const PreintegrationRequest& request);
    std::shared_ptr<const SegmentTable> get(const TransferFunction& transfer_function,
                                            const SegmentTableRequest& request);

  private:
    using Request = std::variant<PreintegrationRequest, SegmentTableRequest>;

    struct Content {
        std::vector<double> knots;
        Request request;
        friend bool operator==(const Content&, const Content&) = default;
    };
    struct Known {
        Content content;
        std::int64_t bytes;
        std::weak_ptr<const void> table;   // of the request's kind
        std::shared_ptr<const void> kept;  // null if only others hold it
    };

    template <typename Table, typename Build>
    std::shared_ptr<const Table> get_or_build(Content content, const Build& build);
    std::shared_ptr<const void> find(const Content& content);
    std::shared_ptr<const void> add(Content content, std::shared_ptr<const void> table,
                                    std::int64_t bytes);
    std::shared_ptr<const void> find_locked(const Content& content);
    void keep_newest();

    std::int64_t most_bytes_;
    std::mutex mutex_;
    std::list<Known> known_;  // the one that was asked for last comes first
};

}  // namespace lamina
