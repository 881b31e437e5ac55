// SPDX-License-Identifier: Apache-2.0
#include "parallel/agreement.h"

#include <cstdio>
#include <new>
#include <string>

#include "base/error.h"
#include "base/error_text.h"

namespace lamina {
namespace {

// Takes no memory when there is none: so short a text lies in the string itself.
std::string message_of(const std::exception& error) {
    return error_text(error);
}

}  // namespace

void agree(const Ranks& ranks, const std::function<void()>& work) {
    std::exception_ptr failure;
    std::string message;
    try {
        work();
    } catch (const std::exception& error) {
        failure = std::current_exception();
        message = message_of(error);
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
        std::fprintf(stderr, "lamina: %s (rank %d of %d)\n", message_of(error).c_str(),
                     ranks.number(), ranks.count());
        MPI_Abort(ranks.comm(), 1);
    }
}

}  // namespace lamina
