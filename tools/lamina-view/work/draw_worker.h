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
    Revisions revisions;                      // counts that show which parts of the scene changed
    std::shared_ptr<const Words> words = {};  // changes that the session makes when it chooses
    bool moving = false;  // something is being dragged: a coarse picture suffices
    bool coarse = true;   // allows coarse pictures
    bool trace = true;    // at rest, the tracer replaces the picture
    std::shared_ptr<const PinnedPicture> pinned = {};  // picture A, drawn in this view, too
    std::uint64_t number = 0;                          // counts requests
    using Clock = std::chrono::steady_clock;
    Clock::time_point asked_at = {};  // time of the input, for measurements
};

// Chooses how small a picture must be to arrive in time while the camera moves, from the times of
// pictures of each size. A new time scales the others, because views differ in cost. Between two
// sizes with known times, time is linear in the number of pixels. Beyond them, larger pictures are
// expected to take time in proportion to their pixels, and smaller ones in proportion to the square
// root, because part of the work (the order of tets) does not depend on size.
class CoarseSize {
  public:
    explicit CoarseSize(double target_ms) : target_ms_(target_ms) {}

    // Adds the time of a picture whose sides were divided by `divisor`, one of `divisors`.
    void add(double divisor, double ms);
    // Returns the smallest divisor with which pictures are expected in time. If there is none,
    // returns the smallest one that takes at most a quarter longer than the fastest.
    double divisor() const;

    static constexpr std::array<double, 9> divisors{1, 1.5, 2, 3, 4, 6, 8, 12, 16};

  private:
    static constexpr std::size_t size = divisors.size();

    double expected_ms(std::size_t index) const;

    double target_ms_;               // time in which a picture should be drawn
    std::array<double, size> ms_{};  // time of pictures of each divisor; 0: unknown
};

class SessionSteps;

// Draws in a thread of its own, which owns the session. Only the newest request counts: it stops
// the work for older ones at once, with two exceptions. If both requests are for moving pictures,
// the older picture is finished unless it has taken 200 ms already; otherwise steady motion might
// let no picture be finished. And loading data continues unless other data are requested.
class DrawWorker {
  public:
    // `wake`: called in the worker's thread, or in its session's, when shown() has changed.
    DrawWorker(const SessionOptions& options, std::function<void()> wake);
    ~DrawWorker();  // stops the current work

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
    std::stop_source running_;         // stops the present step
    bool running_moves_ = false;       // the present step draws a moving picture
    std::uint64_t running_loads_ = 0;  // Revisions::data of the data being loaded
    Clock::time_point running_since_ = {};
    std::unique_ptr<SessionSteps> steps_;  // used only by the worker's thread
    std::thread thread_;
};

}  // namespace lamina::view
