// SPDX-License-Identifier: Apache-2.0
#include "parallel/ranks.h"

#include <cstdint>

namespace lamina {

Ranks::Ranks(MPI_Comm comm) : comm_(comm) {
    MPI_Comm_rank(comm_, &number_);
    MPI_Comm_size(comm_, &count_);
}

void Ranks::broadcast(std::string& text) const {
    auto size = static_cast<std::int32_t>(text.size());
    broadcast(size);
    text.resize(static_cast<std::size_t>(size));
    MPI_Bcast(text.data(), size, MPI_CHAR, 0, comm_);
}

}  // namespace lamina
