// SPDX-License-Identifier: Apache-2.0
#include "parallel/ranks.h"

#include <sched.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <new>
#include <vector>

#include "base/error.h"
#include "base/memory.h"

namespace lamina {

Ranks::Ranks(MPI_Comm comm) : comm_(comm) {
    MPI_Comm_rank(comm_, &number_);
    MPI_Comm_size(comm_, &count_);
}

void Ranks::broadcast(std::string& text, int from) const {
    auto size = static_cast<int>(text.size());
    MPI_Bcast(&size, 1, MPI_INT, from, comm_);
    text.resize(static_cast<std::size_t>(size));
    MPI_Bcast(text.data(), size, MPI_CHAR, from, comm_);
}

void agree(const Ranks& ranks, const std::function<void()>& work) {
    std::exception_ptr failure;
    std::string message;
    try {
        work();
    } catch (const std::exception& error) {
        failure = std::current_exception();
        message = error_text(error);
    }
    int first = failure ? ranks.number() : ranks.count();
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, ranks.comm());
    if (first == ranks.count()) return;
    if (first == 0) {
        if (failure && ranks.leads()) std::rethrow_exception(failure);
        fail("rank 0 has failed");
    }
    ranks.broadcast(message, first);
    fail("{} (rank {} of {})", message, first, ranks.count());
}

void do_or_abort(const Ranks& ranks, const std::function<void()>& work) {
    try {
        work();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lamina: %s (rank %d of %d)\n", error_text(error).c_str(),
                     ranks.number(), ranks.count());
        MPI_Abort(ranks.comm(), 1);
    }
}

RankResources::RankResources(const Ranks& ranks) {
    MPI_Comm machine = MPI_COMM_NULL;
    MPI_Comm_split_type(ranks.comm(), MPI_COMM_TYPE_SHARED, ranks.number(), MPI_INFO_NULL,
                        &machine);
    int count = 1;
    MPI_Comm_size(machine, &count);
    // All ranks get the smallest limit, so that a volume is in memory on all ranks or on none.
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
