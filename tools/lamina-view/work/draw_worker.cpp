// SPDX-License-Identifier: Apache-2.0
#include "work/draw_worker.h"

#include <utility>

#include "work/session_steps.h"

namespace lamina::view {

DrawWorker::DrawWorker(const SessionOptions& options, std::function<void()> wake)
    : wake_(std::move(wake)),
      shown_(std::make_shared<const Shown>()),
      steps_(
          std::make_unique<SessionSteps>(options, [this](const Shown& shown) { publish(shown); })),
      thread_([this] { run(); }) {}

DrawWorker::~DrawWorker() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        running_.request_stop();
    }
    changed_.notify_one();
    thread_.join();
}

void DrawWorker::request(DrawRequest request) {
    {
        const std::lock_guard lock(mutex_);
        newest_ = std::move(request);
        running_.request_stop();
    }
    changed_.notify_one();
}

std::shared_ptr<const Shown> DrawWorker::shown() const {
    const std::lock_guard lock(shown_mutex_);
    return shown_;
}

void DrawWorker::publish(const Shown& shown) {
    auto next = std::make_shared<const Shown>(shown);
    {
        const std::lock_guard lock(shown_mutex_);
        shown_ = std::move(next);
    }
    wake_();
}

void DrawWorker::run() {
    for (;;) {
        std::optional<DrawRequest> request;
        std::stop_token stop;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return ending_ || newest_ || steps_->unfinished(); });
            if (ending_) break;
            request = std::exchange(newest_, std::nullopt);
            running_ = std::stop_source();
            stop = running_.get_token();
        }
        if (request) steps_->begin(std::move(*request));
        steps_->step(stop);
    }
    steps_.reset();  // a session ends in the thread that it drew in
}

}  // namespace lamina::view
