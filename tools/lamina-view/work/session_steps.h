// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "lamina/scene.h"
#include "lamina/session.h"
#include "work/draw_worker.h"
#include "work/shown.h"

namespace lamina::view {

// Returns the keys that `asked` leaves automatic and that differ between two choices, one line
// each: "render.slice.samples: 300 -> 320".
std::vector<std::string> automatic_differences(const Scene& before, const Scene& after,
                                               const Scene& asked);

class TracedPicture;

// Does the work for a request step by step: loads data, then draws. While the scene moves, it draws
// a coarse picture. At rest, it chooses automatic keys again, draws the full picture, draws the
// pinned picture in the same view, and traces. Used by one thread only.
class SessionSteps {
  public:
    SessionSteps(const SessionOptions& options, std::function<void(const Shown&)> publish);
    ~SessionSteps();

    void begin(DrawRequest request);  // drops the remaining steps of the request before
    bool unfinished() const { return next_ != Next::nothing; }
    bool moves() const { return next_ == Next::moving; }
    bool loads() const { return next_ == Next::load; }
    // Does the next step. Errors are published; a step that was stopped is done again.
    void step(const std::stop_token& stop);

  private:
    enum class Next { nothing, load, moving, full, pinned, trace };
    Next step_after_data() const;
    void load(const std::stop_token& stop);
    void draw_moving(const std::stop_token& stop);
    void draw_full(const std::stop_token& stop);
    void draw_pinned(const std::stop_token& stop);
    void trace(const std::stop_token& stop);
    std::shared_ptr<const PinnedPicture> pinned() const;
    Next step_after_full() const;
    void apply_change();
    void choose();
    double set_size_for_moving();
    void show(PictureKind kind, const Image& picture);
    void tell_plan();
    void show_traced(const TracedPicture& traced);
    void take_truth(const PreciseImage& truth);
    void add_warnings();  // adds the session's new warnings to the shown ones
    void forget_tiles();
    void forget_pictures();  // when the data change
    void fail(const std::string& message);
    ProgressCallback progress();

    SessionOptions options_;
    std::function<void(const Shown&)> publish_;
    DrawRequest request_;
    Next next_ = Next::nothing;
    std::unique_ptr<Session> session_;
    Revisions applied_;      // revisions that the session has
    Revisions chosen_;       // revisions that automatic values were chosen for
    bool full_size_ = true;  // the session has the request's size, not a coarse one
    CoarseSize coarse_size_;
    bool holds_pinned_ = false;  // the session has the scene of A
    Revisions pinned_failed_;    // of the request in whose view A could not be drawn
    Shown shown_;
};

}  // namespace lamina::view
