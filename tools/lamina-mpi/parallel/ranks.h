// SPDX-License-Identifier: Apache-2.0
// MPI, which only this room and the program lamina-mpi use. An error of MPI ends the whole job,
// which is MPI's default.
#pragma once

#include <mpi.h>
#include <tbb/global_control.h>

#include <exception>
#include <functional>
#include <optional>
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

// Does a step of the job on every rank and waits for the others. `work` must not wait for another
// rank. If it throws on any rank, this function throws on all of them: on rank 0 its own exception,
// or an Error with the message and the number of the first rank that failed; on the others an
// Error.
void agree(const Ranks& ranks, const std::function<void()>& work);

// Does a step in which ranks wait for one another. If it throws on one rank, the others would wait
// forever; so the whole job ends with a message.
void do_or_abort(const Ranks& ranks, const std::function<void()>& work);

// Limits this rank to its part of the machine's memory, and its threads, while it lives, to its
// part of the processors: ranks on the same set of processors divide these among themselves.
class RankResources {
  public:
    explicit RankResources(const Ranks& ranks);

  private:
    std::optional<tbb::global_control> threads_;
};

}  // namespace lamina
