// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "lamina/image.h"
#include "parallel/fragment_code.h"
#include "parallel/ranks.h"
#include "render/pipeline.h"

namespace lamina {

// Composites the pictures of all ranks by direct send: each rank receives some rows from all
// others, composites them front to back in float, and sends the result to rank 0. If there are more
// than `most_in_group` ranks, groups of ranks that are contiguous in depth composite first, and
// then the groups' pictures are composited (docs/cluster.md).
class PictureComposer {
  public:
    static constexpr int usual_group = 64;

    // `ranks` must outlive the composer.
    PictureComposer(const Ranks& ranks, Wire wire, int most_in_group = usual_group)
        : ranks_(ranks), wire_(wire), most_in_group_(most_in_group) {}

    // Composites the pictures of all ranks, which have the same size, into rank 0's `picture`.
    // `order` has all ranks in visibility order, nearest first. All ranks must call this function.
    void compose(const std::vector<int>& order, Image& picture);

    std::int64_t bytes_sent() const { return bytes_sent_; }  // by this rank in the last call
    std::int64_t messages_sent() const { return messages_sent_; }

  private:
    // Rows that rank `from` sends to rank `to`. If both are equal, the rank composites the rows of
    // its own picture into its result.
    struct Transfer {
        int from, to;
        RowSpan rows;
    };
    class Layout;

    std::vector<std::int64_t> row_weights(const ActiveRuns& runs, int rows) const;
    // Sends rows of `picture`, and composites the rows that arrive into `result`, front to back in
    // the order of `transfers`. `runs` has the runs of all rows, or is null: they are then found.
    void exchange(const std::vector<Transfer>& transfers, FragmentFormat format,
                  const Image& picture, const ActiveRuns* runs, Image& result);
    void receive(int rank, std::vector<std::byte>& bytes) const;

    const Ranks& ranks_;
    Wire wire_;
    int most_in_group_;
    Image of_group_, composed_;  // rows composited by this rank: over its group; over all groups
    std::int64_t bytes_sent_ = 0, messages_sent_ = 0;
};

// Times, memory and traffic of a frame on one rank. Each rank sends it to rank 0 as bytes.
struct RankReport {
    std::array<char, 64> machine{};  // name of the host, zero-terminated
    std::int32_t threads = 0;
    double draw_ms = 0;         // time to plan and draw the rank's share
    double composite_ms = 0;    // time to composite, including waits for other ranks
    std::int64_t segments = 0;  // number of ray segments drawn
    std::int64_t bytes_sent = 0, messages_sent = 0;
    std::int64_t peak_memory = 0;  // largest resident size since the start, bytes
};

// Draws one share of a scene's volume and composites it with the shares of other ranks. Every rank
// has one for the same scene, and all of them call draw() together.
class SharedRenderer {
  public:
    // Throws Error if the scene has a setting that ranks cannot share. Its method must be `slice`.
    // `ranks` must outlive the renderer. `many_frames`, `tables`: as in PipelineOptions.
    SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene, SceneData data,
                   const OmissionSwitch& omissions, bool many_frames,
                   std::shared_ptr<TableCache> tables);

    // Returns the pipeline that draws this rank's share.
    Pipeline& own() { return own_; }

    // Measures, plans and makes the renderer, on each rank independently.
    void set_up() { own_.set_up(); }
    // Throws Error on all ranks if their plans differ.
    void check_plan();

    // Draws a frame. `camera`, if given, replaces the last one. Afterwards rank 0 has the picture
    // and the reports of all ranks.
    void draw(const std::optional<Camera>& camera);
    const Image& picture() const { return picture_; }
    const std::vector<RankReport>& reports() const { return reports_; }

  private:
    const Ranks& ranks_;
    Pipeline own_;
    PictureComposer composer_;
    Image picture_;
    std::vector<RankReport> reports_;
};

}  // namespace lamina
