// SPDX-License-Identifier: Apache-2.0
// This room and the program lamina-mpi alone know MPI. Its errors end the whole job, as MPI has it
// by default.
#pragma once

#include <mpi.h>

#include <string>

namespace lamina {

// The processes of a job, as one of them sees them.
class Ranks {
  public:
    explicit Ranks(MPI_Comm comm);

    MPI_Comm comm() const { return comm_; }
    int number() const { return number_; }  // of this process, 0 .. count() - 1
    int count() const { return count_; }
    bool leads() const { return number_ == 0; }

    // Gives all ranks the text that one of them has.
    void broadcast(std::string& text, int from = 0) const;

  private:
    MPI_Comm comm_;
    int number_ = 0, count_ = 1;
};

}  // namespace lamina
