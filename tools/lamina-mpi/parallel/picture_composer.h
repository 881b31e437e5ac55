// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lamina/image.h"
#include "parallel/fragment_code.h"
#include "parallel/ranks.h"
#include "parallel/wire.h"

namespace lamina {

// Composites the pictures of all ranks by direct send: each rank gets some rows from all others,
// composites them front to back in float, and sends the result to rank 0. Of more than
// `most_in_group` ranks those that are contiguous in depth do so among themselves first: groups are
// nodes of a tree (docs/cluster.md).
class PictureComposer {
  public:
    static constexpr int usual_group = 64;

    // `ranks` must outlive it.
    PictureComposer(const Ranks& ranks, Wire wire, int most_in_group = usual_group)
        : ranks_(ranks), wire_(wire), most_in_group_(most_in_group) {}

    // Rank 0's `picture` becomes that of all. `order`: the ranks, nearer ones first. Pictures have
    // the same size. All ranks must call it.
    void compose(const std::vector<int>& order, Image& picture);

    std::int64_t bytes_sent() const { return bytes_sent_; }  // by this rank in the last call
    std::int64_t messages_sent() const { return messages_sent_; }

  private:
    // Rows of one rank's picture on their way to another one or, where the two are the same, to
    // its other picture.
    struct Transfer {
        int from, to;
        RowSpan rows;
    };
    class Layout;

    std::vector<std::int64_t> row_weights(const ActiveRuns& runs, int rows) const;
    // Sends rows of `picture`, and composites those that arrive in `result`, front to back in the
    // order of `transfers`. `runs`: of all of `picture`, or null.
    void exchange(const std::vector<Transfer>& transfers, FragmentFormat format,
                  const Image& picture, const ActiveRuns* runs, Image& result);
    void receive(int rank, std::vector<std::byte>& bytes) const;

    const Ranks& ranks_;
    Wire wire_;
    int most_in_group_;
    Image of_group_, composed_;  // the rows that this rank composites
    std::int64_t bytes_sent_ = 0, messages_sent_ = 0;
};

}  // namespace lamina
