// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace lamina::study {

// How long the rest of a study takes, from the visits to runs so far. First visits, which read
// data, trace, set up and draw the first picture, and later ones are held apart.
class TimeLeft {
  public:
    // `timing`: what of `seconds` was the timing of frames, which is all that a later visit does.
    void add_first(double seconds, double timing);
    void add_later(double seconds);

    // Seconds for so many visits of each kind. There was a first one.
    double of(std::size_t first_visits, std::size_t later_visits) const;

  private:
    double first_seconds_ = 0, first_timing_ = 0, later_seconds_ = 0;
    std::size_t first_visits_ = 0, later_visits_ = 0;
};

// "8 s", "3 min", "2 h 10 min": two digits or so.
std::string duration_text(double seconds);

}  // namespace lamina::study
