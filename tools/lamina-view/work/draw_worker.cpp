// SPDX-License-Identifier: Apache-2.0
#include "work/draw_worker.h"

#include <utility>

#include "work/session_steps.h"

namespace lamina::view {
namespace {

constexpr auto longest_moving = std::chrono::milliseconds(200);

}  // namespace

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
        const bool moves_on =
            running_moves_ && request.moving && Clock::now() - running_since_ < longest_moving;
        const bool finish = moves_on || running_loads_ == request.revisions.data;
        newest_ = std::move(request);
        busy_ = true;
        if (!finish) running_.request_stop();
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
    std::uint64_t loading = 0;  // of the last request
    for (;;) {
        std::optional<DrawRequest> request;
        std::stop_token stop;
        {
            std::unique_lock lock(mutex_);
            busy_ = newest_ || steps_->unfinished();
            changed_.wait(lock, [&] { return ending_ || newest_ || steps_->unfinished(); });
            if (ending_) break;
            request = std::exchange(newest_, std::nullopt);
            if (request) {
                loading = request->revisions.data;
                steps_->begin(std::move(*request));
            }
            running_ = std::stop_source();
            running_moves_ = steps_->moves();
            running_loads_ = steps_->loads() ? loading : 0;
            running_since_ = Clock::now();
            stop = running_.get_token();
        }
        steps_->step(stop);
    }
    steps_.reset();  // a session ends in the thread that it drew in
}

}  // namespace lamina::view
