// SPDX-License-Identifier: Apache-2.0
#include "parallel/ranks.h"

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

}  // namespace lamina
