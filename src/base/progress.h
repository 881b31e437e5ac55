// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "base/client.h"
#include "base/profile.h"

namespace lamina {

// A line on stderr with the share done and the time left, for work that takes longer than a second
// or so. It is drawn only on a terminal, at most twice a second, and wiped at the end; elsewhere
// nothing is shown. If several exist at a time, only the first is drawn, that of the whole work.
// Work for a client that listens (base/client.h) reports to the client, some 20 times a second and
// at its end.
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
    bool begin();

    ProgressListener* listener_;  // null: the terminal
    std::string label_;
    std::int64_t total_;
    bool visible_;
    std::atomic<std::int64_t> done_{0};
    std::atomic_flag drawing_;        // set while a thread draws
    std::atomic<bool> ended_{false};  // true once a listener has heard the end
    double last_drawn_ = 0;
    bool drawn_ = false;
    Stopwatch watch_;
};

}  // namespace lamina
