// SPDX-License-Identifier: Apache-2.0
#include "study/time_left.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

namespace lamina::study {
namespace {

constexpr double steps = 1e6;  // of the progress bar, from 0 to 100 %
constexpr std::chrono::milliseconds pause(500);

// The time left is assumed to be at least this share of the time so far, whatever was predicted.
constexpr double least_left = 0.02;

// Time for a tet, in seconds on one processor. TetGen and the search for the largest errors take
// most of it (measured: .00022 on an EPYC with AVX2, 2026-11).
constexpr double usual_seconds_a_tet = 2.5e-4;

// Exponents p in: number of tets ~ (1 / tolerance)^p. A field with second derivatives needs
// p = 1.5, noise nearly p = 3.
constexpr double least_power = 1.5, usual_power = 2.5, largest_power = 3.5;

// Number of tets of all meshes of a ladder that halves its tolerances, over that of the last
// one: 1 + 2^-1.5 + 2^-3 + ...
constexpr double sum_of_ladder = 1.55;

}  // namespace

void TimeLeft::add_first(double seconds, double timing) {
    ++first_visits_;
    first_seconds_ += seconds;
    first_timing_ += timing;
}

void TimeLeft::add_later(double seconds) {
    ++later_visits_;
    later_seconds_ += seconds;
}

double TimeLeft::of(std::size_t first_visits, std::size_t later_visits) const {
    assert(first_visits_ > 0);
    const auto seen = static_cast<double>(first_visits_);
    const double a_later_one = later_visits_ > 0
                                   ? later_seconds_ / static_cast<double>(later_visits_)
                                   : first_timing_ / seen;
    return static_cast<double>(first_visits) * first_seconds_ / seen +
           static_cast<double>(later_visits) * a_later_one;
}

std::string duration_text(double seconds) {
    const auto whole = [](double value) { return static_cast<long long>(std::llround(value)); };
    if (seconds < 0.5) return "less than 1 s";
    if (whole(seconds) < 100) return fmt::format("{} s", whole(seconds));
    const long long minutes = whole(seconds / 60);
    if (minutes < 100) return fmt::format("{} min", minutes);
    const long long hours = minutes / 60;
    if (hours < 100) return fmt::format("{} h {} min", hours, minutes % 60);
    return fmt::format("{} days", whole(seconds / 86400));
}

TimedProgress::TimedProgress(const std::string& label)
    : progress_(label, static_cast<std::int64_t>(steps)),
      thread_([this](const std::stop_token& stop) { keep_showing(stop); }) {}

void TimedProgress::expect(double seconds_left) {
    const std::scoped_lock lock(mutex_);
    expected_end_ = watch_.seconds() + seconds_left;
    show();
}

void TimedProgress::keep_showing(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        woken_.wait_for(lock, stop, pause, [] { return false; });
        if (!stop.stop_requested()) show();
    }
}

// Progress derives the time left from the share that is done, so the share is set to match.
void TimedProgress::show() {
    const double now = watch_.seconds();
    const double left = std::max(expected_end_ - now, least_left * now);
    const auto done = std::llround(steps * now / std::max(now + left, 1e-9));
    progress_.advance(done - shown_);
    shown_ = done;
}

void LadderCost::add(double tolerance, std::int64_t tets, double seconds) {
    const Made made{tolerance, static_cast<double>(std::max<std::int64_t>(tets, 1))};
    power_ = usual_power;
    if (last_ && made.tolerance < last_->tolerance)
        power_ = std::clamp(
            std::log(made.tets / last_->tets) / std::log(last_->tolerance / made.tolerance),
            least_power, largest_power);
    seconds_a_tet_ = seconds / made.tets;
    last_ = made;
}

double LadderCost::most_seconds(std::span<const Step> steps) {
    // Tets of the meshes that do not end the ladder; of the others, the largest mesh and the sum.
    double full = 0, tets = 0;
    double ladder = 0;
    for (const Step& step : steps) {
        const auto most = static_cast<double>(step.most_tets);
        if (!step.last_if_full) {
            tets += most;
            continue;
        }
        full = std::max(full, most);
        ladder += most;
    }
    return usual_seconds_a_tet * (tets + std::min(ladder, sum_of_ladder * full));
}

double LadderCost::expected_seconds(std::span<const Step> steps) const {
    assert(last_);
    double seconds = 0;
    bool full = false;
    for (const Step& step : steps) {
        if (step.last_if_full && full) continue;
        const auto most = static_cast<double>(step.most_tets);
        const double tets =
            std::min(most, last_->tets * std::pow(last_->tolerance / step.tolerance, power_));
        seconds += tets * seconds_a_tet_;
        full = full || (step.last_if_full && tets >= most);
    }
    return seconds;
}

}  // namespace lamina::study
