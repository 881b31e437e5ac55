// SPDX-License-Identifier: Apache-2.0
#include "work/draw_worker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "work/session_steps.h"

namespace lamina::view {

void CoarseSize::add(double divisor, double ms) {
    const auto index =
        static_cast<std::size_t>(std::ranges::find(divisors, divisor) - divisors.begin());
    if (ms_[index] > 0)
        for (double& other : ms_) other *= ms / ms_[index];
    ms_[index] = ms;
}

double CoarseSize::expected_ms(std::size_t index) const {
    if (ms_[index] > 0) return ms_[index];
    std::size_t finer = index, coarser = index;
    while (finer > 0 && ms_[finer] == 0) --finer;
    while (coarser + 1 < size && ms_[coarser] == 0) ++coarser;
    const auto pixels = [&](std::size_t i) { return 1 / (divisors[i] * divisors[i]); };
    if (ms_[finer] == 0) return ms_[coarser] * pixels(index) / pixels(coarser);
    if (ms_[coarser] == 0) return ms_[finer] * std::sqrt(pixels(index) / pixels(finer));
    const double share = (pixels(index) - pixels(coarser)) / (pixels(finer) - pixels(coarser));
    return std::lerp(ms_[coarser], ms_[finer], share);
}

double CoarseSize::divisor() const {
    if (std::ranges::max(ms_) == 0) return 4;
    std::array<double, size> ms{};
    for (std::size_t i = 0; i < size; ++i) ms[i] = expected_ms(i);
    const double enough = std::max(target_ms_, 1.25 * std::ranges::min(ms));
    return divisors[static_cast<std::size_t>(
        std::ranges::find_if(ms, [&](double each) { return each <= enough; }) - ms.begin())];
}

namespace {

constexpr auto longest_moving = std::chrono::milliseconds(200);  // see DrawWorker

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
    std::uint64_t loading = 0;  // Revisions::data of the last request
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
    steps_.reset();  // a session must end in its own thread
}

}  // namespace lamina::view
