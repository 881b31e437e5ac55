// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "base/stopwatch.h"

namespace lamina {

// A line on stderr with the share of work that is done and the time that is left, for work that
// takes longer than about a second. It is drawn only on a terminal, at most twice a second, and
// wiped at the end. Of several at a time only the first is drawn, which stands for the whole work.
class Progress {
  public:
    Progress(std::string label, std::int64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance(std::int64_t steps = 1);  // safe from any thread

    static void set_quiet(bool quiet);  // for the whole process (--quiet)
    static bool is_quiet();

  private:
    void draw(std::int64_t done);

    std::string label_;
    std::int64_t total_;
    bool visible_;
    std::atomic<std::int64_t> done_{0};
    std::mutex drawing_;
    double last_drawn_ = 0;
    bool drawn_ = false;
    Stopwatch watch_;
};

}  // namespace lamina
