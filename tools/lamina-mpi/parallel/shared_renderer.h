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

// A frame's times, memory and traffic on one rank. Ranks send it as bytes.
struct RankReport {
    std::array<char, 64> machine{};  // its name, zero-terminated
    std::int32_t threads = 0;
    double draw_ms = 0;       // time to plan and draw the rank's share
    double composite_ms = 0;  // time to composite, waiting for other ranks included
    std::int64_t segments = 0;
    std::int64_t bytes_sent = 0, messages_sent = 0;
    std::int64_t peak_memory = 0;  // largest resident size since the start, bytes
};

// Draws one share of a scene's volume and composites it with the shares of the other ranks. Every
// rank has a renderer of the same scene, and all call draw() together.
class SharedRenderer {
  public:
    // Throws Error if the scene has a setting that ranks cannot share. Its method must be `slice`.
    // `ranks` must outlive the renderer. `many_frames`, `tables`: as in PipelineOptions.
    SharedRenderer(const Ranks& ranks, Wire wire, const Scene& scene, SceneData data,
                   const OmissionSwitch& omissions, bool many_frames,
                   std::shared_ptr<TableCache> tables);

    // The pipeline that draws this rank's share.
    Pipeline& own() { return own_; }

    // Measures the data, plans and makes the renderer: each rank by itself, all at the same time.
    void set_up() { own_.set_up(); }
    // Throws Error on all ranks if their plans differ.
    void check_plan();

    // Draws a frame, with another camera or as before. Rank 0 then has the picture and the reports
    // of all ranks.
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
