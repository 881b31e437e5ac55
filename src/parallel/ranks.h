// SPDX-License-Identifier: Apache-2.0
// This room and the program lamina-mpi alone know MPI. Its errors end the whole job, as MPI has it
// by default.
#pragma once

#include <mpi.h>

#include <string>
#include <type_traits>

namespace lamina {

// The processes of a job, as one of them sees them.
class Ranks {
  public:
    explicit Ranks(MPI_Comm comm);

    MPI_Comm comm() const { return comm_; }
    int number() const { return number_; }  // of this process, 0 .. count() - 1
    int count() const { return count_; }
    bool leads() const { return number_ == 0; }

    // From rank 0 to all. `Value` is copied byte by byte.
    template <typename Value>
    void broadcast(Value& value) const {
        static_assert(std::is_trivially_copyable_v<Value>);
        MPI_Bcast(&value, sizeof value, MPI_BYTE, 0, comm_);
    }
    void broadcast(std::string& text) const;

  private:
    MPI_Comm comm_;
    int number_ = 0, count_ = 1;
};

}  // namespace lamina
