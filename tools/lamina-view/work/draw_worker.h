// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
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

// Draws in a thread of its own, which owns the session. Only the newest request counts.
class DrawWorker {
  public:
    // `wake` is called, in the worker's thread, whenever shown() has changed.
    DrawWorker(const SessionOptions& options, std::function<void()> wake);
    ~DrawWorker();  // stops what is being done

    void request(DrawRequest request);
    std::shared_ptr<const Shown> shown() const;  // never null

  private:
    void run();
    void publish(const Shown& shown);

    std::function<void()> wake_;
    mutable std::mutex shown_mutex_;
    std::shared_ptr<const Shown> shown_;

    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<DrawRequest> newest_;
    bool ending_ = false;
    std::stop_source running_;
    std::unique_ptr<SessionSteps> steps_;  // the worker thread's own
    std::thread thread_;
};

}  // namespace lamina::view
