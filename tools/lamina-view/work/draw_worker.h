// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "lamina/scene.h"
#include "lamina/session.h"
#include "model/document.h"
#include "work/shown.h"

namespace lamina::view {

// A request for a picture.
struct DrawRequest {
    Scene scene;
    Revisions revisions;  // which parts of the scene differ from the request before
    bool moving = false;  // something is being dragged: a coarse picture serves
    bool coarse = true;   // whether it may get one
    bool trace = true;    // whether the tracer replaces the picture at rest
    std::shared_ptr<const PinnedPicture> pinned = {};  // to be kept in the view of the scene
    std::uint64_t number = 0;
    using Clock = std::chrono::steady_clock;
    Clock::time_point asked_at = {};  // of the input, for measurements
};

// Chooses how small a picture has to be to arrive in time while the camera moves. It keeps the
// times of pictures of each size. A new time scales the others, because views differ in cost.
// Between two sizes with known times, time is linear in the number of pixels. Beyond them, larger
// pictures are expected to take longer in proportion to their pixels, and smaller ones to be faster
// by the square root of that, because part of the work (order of tets) does not depend on size.
class CoarseSize {
  public:
    explicit CoarseSize(double target_ms) : target_ms_(target_ms) {}

    // Records the time of a picture whose edges were divided by this one of `divisors`.
    void add(double divisor, double ms);
    // The least one of `divisors` with which pictures are in time, as far as is known. If there is
    // none, the least one that takes at most a quarter longer than the quickest.
    double divisor() const;

    static constexpr std::array<double, 9> divisors{1, 1.5, 2, 3, 4, 6, 8, 12, 16};

  private:
    static constexpr std::size_t size = divisors.size();

    double expected_ms(std::size_t index) const;

    double target_ms_;
    std::array<double, size> ms_{};  // 0: not known
};

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
