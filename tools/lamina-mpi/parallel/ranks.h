// SPDX-License-Identifier: Apache-2.0
// Wraps MPI, which only this folder and the program lamina-mpi use. An error of MPI ends the whole
// job, as is MPI's default.
#pragma once

#include <mpi.h>
#include <tbb/global_control.h>

#include <exception>
#include <functional>
#include <optional>
#include <string>

namespace lamina {

// The ranks (processes) of an MPI job, seen from this rank.
class Ranks {
  public:
    explicit Ranks(MPI_Comm comm);

    MPI_Comm comm() const { return comm_; }
    int number() const { return number_; }  // of this process, 0 .. count() - 1
    int count() const { return count_; }
    bool leads() const { return number_ == 0; }

    // Sends the text of rank `from` to all ranks.
    void broadcast(std::string& text, int from = 0) const;

  private:
    MPI_Comm comm_;
    int number_ = 0, count_ = 1;
};

// Calls work() on every rank and waits for the others. `work` must not wait for other ranks. If it
// throws on any rank, this function throws on all of them: on rank 0 its own exception, or an Error
// with message and number of the first rank that failed; on the others an Error.
void agree(const Ranks& ranks, const std::function<void()>& work);

// Calls work(), in which ranks wait for one another. If it throws on one rank, the others would
// wait forever, so the whole job ends with a message.
void do_or_abort(const Ranks& ranks, const std::function<void()>& work);

// Limits this rank to its share of the machine's memory and, while it lives, to its share of the
// processors: ranks with the same set of processors divide it among them.
class RankResources {
  public:
    explicit RankResources(const Ranks& ranks);

  private:
    std::optional<tbb::global_control> threads_;
};

}  // namespace lamina
