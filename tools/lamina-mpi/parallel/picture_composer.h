// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/image.h"
#include "parallel/fragment_code.h"
#include "parallel/ranks.h"

namespace lamina {

// Composites the pictures of all ranks by direct send: each rank gets some rows from all others,
// composites them front to back in float, and sends the result to rank 0. If there are more than
// `most_in_group` ranks, groups that are contiguous in depth composite among themselves first: they
// are nodes of a tree (docs/cluster.md).
class PictureComposer {
  public:
    static constexpr int usual_group = 64;

    // `ranks` must outlive it.
    PictureComposer(const Ranks& ranks, Wire wire, int most_in_group = usual_group)
        : ranks_(ranks), wire_(wire), most_in_group_(most_in_group) {}

    // Composites the pictures of all ranks, which have the same size, into rank 0's `picture`.
    // `order`: the ranks, nearest first. All ranks must call it.
    void compose(const std::vector<int>& order, Image& picture);

    std::int64_t bytes_sent() const { return bytes_sent_; }  // by this rank in the last call
    std::int64_t messages_sent() const { return messages_sent_; }

  private:
    // Rows of one rank's picture that go to another rank or, if the two are the same, to that
    // rank's other picture.
    struct Transfer {
        int from, to;
        RowSpan rows;
    };
    class Layout;

    std::vector<std::int64_t> row_weights(const ActiveRuns& runs, int rows) const;
    // Sends rows of `picture`, and composites those that arrive in `result`, front to back in the
    // order of `transfers`. `runs`: the runs of the whole `picture`, or null.
    void exchange(const std::vector<Transfer>& transfers, FragmentFormat format,
                  const Image& picture, const ActiveRuns* runs, Image& result);
    void receive(int rank, std::vector<std::byte>& bytes) const;

    const Ranks& ranks_;
    Wire wire_;
    int most_in_group_;
    Image of_group_, composed_;  // rows that this rank composites
    std::int64_t bytes_sent_ = 0, messages_sent_ = 0;
};

}  // namespace lamina
