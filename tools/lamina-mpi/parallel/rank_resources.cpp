// SPDX-License-Identifier: Apache-2.0
#include "parallel/rank_resources.h"

#include <sched.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/memory_limit.h"

namespace lamina {

RankResources::RankResources(const Ranks& ranks) {
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(ranks.comm(), MPI_COMM_TYPE_SHARED, ranks.number(), MPI_INFO_NULL,
                        &machine);
    int count = 1;
    MPI_Comm_size(machine, &count);
    // All ranks get the least, so that a volume is in memory on all of them or on none.
    std::uint64_t memory = memory_limit() / static_cast<unsigned>(count);
    MPI_Allreduce(MPI_IN_PLACE, &memory, 1, MPI_UINT64_T, MPI_MIN, ranks.comm());
    set_default_memory_limit(memory);
    cpu_set_t own;
    CPU_ZERO(&own);
    sched_getaffinity(0, sizeof own, &own);
    std::vector<cpu_set_t> all(static_cast<std::size_t>(count));
    MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, machine);
    const auto together =
        std::ranges::count_if(all, [&](const cpu_set_t& other) { return CPU_EQUAL(&own, &other); });
    threads_.emplace(
        tbb::global_control::max_allowed_parallelism,
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, CPU_COUNT(&own) / together)));
    MPI_Comm_free(&machine);
}

}  // namespace lamina
