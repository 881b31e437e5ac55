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
// most_in_group ranks those that are contiguous in depth do so among themselves first: groups are
// nodes of a tree (docs/cluster.md).
class PictureComposer {
  public:
    static constexpr int most_in_group = 16;

    // `ranks` must outlive it.
    PictureComposer(const Ranks& ranks, Wire wire) : ranks_(ranks), wire_(wire) {}

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

    void measure(const Image& picture);
    // Sends rows of `picture`, and puts behind what is in `front` those that arrive, in the order
    // of `transfers`.
    void exchange(const std::vector<Transfer>& transfers, FragmentFormat format,
                  const Image& picture, Image& front);

    const Ranks& ranks_;
    Wire wire_;
    std::vector<std::int64_t> row_weights_;  // of all ranks' pictures
    float largest_ = 1;                      // colour of all of them, at least 1
    Image composed_;
    std::int64_t bytes_sent_ = 0, messages_sent_ = 0;
};

}  // namespace lamina
