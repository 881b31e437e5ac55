// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "lamina/session.h"
#include "work/draw_request.h"
#include "work/shown.h"

namespace lamina::view {

class SessionSteps;

// Draws in a thread of its own, which owns the session. Only the newest request counts: it stops
// the work for an older one at once. There are two exceptions. While the scene moves, a picture is
// finished although a newer request moves, too, unless it takes long: otherwise there would be no
// picture as long as it moves. And data are loaded to the end unless others are wanted.
class DrawWorker {
  public:
    // `wake` is called, in the worker's thread or those of its session, whenever shown() has
    // changed.
    DrawWorker(const SessionOptions& options, std::function<void()> wake);
    ~DrawWorker();  // stops what is being done

    void request(DrawRequest request);
    std::shared_ptr<const Shown> shown() const;  // never null
    // Returns true if pictures of the last request may still be published.
    bool busy() const { return busy_; }

  private:
    using Clock = std::chrono::steady_clock;
    void run();
    void publish(const Shown& shown);

    std::function<void()> wake_;
    mutable std::mutex shown_mutex_;
    std::shared_ptr<const Shown> shown_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<DrawRequest> newest_;
    bool ending_ = false;
    std::atomic<bool> busy_{false};
    std::stop_source running_;
    bool running_moves_ = false;
    std::uint64_t running_loads_ = 0;  // Revisions::data of what is being loaded
    Clock::time_point running_since_ = {};
    std::unique_ptr<SessionSteps> steps_;  // the worker thread's own
    std::thread thread_;
};

}  // namespace lamina::view
