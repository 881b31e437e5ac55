// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stop_token>

#include "lamina/session.h"
#include "work/draw_request.h"
#include "work/shown.h"

namespace lamina::view {

// The work for a request, step by step: the data, then the picture. Of one thread.
class SessionSteps {
  public:
    SessionSteps(const SessionOptions& options, std::function<void(const Shown&)> publish);
    ~SessionSteps();

    void begin(DrawRequest request);  // forgets what is left to do of the one before
    bool unfinished() const { return next_ != Next::nothing; }
    // Does the next step. What goes wrong is published; a step that was stopped is left to do.
    void step(const std::stop_token& stop);

  private:
    enum class Next { nothing, load, full };
    void load(const std::stop_token& stop);
    void draw_full(const std::stop_token& stop);
    void apply();
    void publish_chosen();
    void fail(const std::string& message);
    ProgressCallback progress();

    SessionOptions options_;
    std::function<void(const Shown&)> publish_;
    DrawRequest request_;
    Next next_ = Next::nothing;
    std::unique_ptr<Session> session_;
    Revisions applied_;  // what the session has
    Shown shown_;
};

}  // namespace lamina::view
