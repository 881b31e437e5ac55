// SPDX-License-Identifier: Apache-2.0
#include "study/time_left.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace lamina::study {

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

}  // namespace lamina::study
