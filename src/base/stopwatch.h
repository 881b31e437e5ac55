// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace lamina {

class Stopwatch {
  public:
    double seconds() const { return 1e-9 * static_cast<double>(now() - start_ns_); }
    double milliseconds() const { return 1e3 * seconds(); }

    // The current time of the clock that measurements use: nanoseconds since some moment.
    static std::int64_t now() {
        using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::steady_clock;
        return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
    }

  private:
    std::int64_t start_ns_ = now();
};

}  // namespace lamina
