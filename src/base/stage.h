// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <optional>

#include "base/profile.h"
#include "base/stopwatch.h"

namespace lamina {

// A stage of the work. It is timed, and recorded where a Profile exists. It must end in the thread
// that began it, and stages of one thread must end in reverse order.
class Stage {
  public:
    explicit Stage(const char* name) : name_(name) {}  // a literal
    ~Stage() { end(); }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    // Adds a number to the stage before its end; at most as many as Profile::Counts holds.
    void count(const char* name, double value) {
        assert(count_ < counts_.size());
        counts_[count_++] = {name, value};
    }

    // Ends the stage at the first call. Returns its duration in milliseconds.
    double end() {
        if (end_ns_) return 1e-6 * static_cast<double>(*end_ns_ - begin_ns_);
        end_ns_ = Stopwatch::now();
        if (Profile* const profile = Profile::recording())
            profile->add(name_, begin_ns_, *end_ns_, counts_);
        return 1e-6 * static_cast<double>(*end_ns_ - begin_ns_);
    }

  private:
    const char* name_;
    std::int64_t begin_ns_ = Stopwatch::now();
    std::optional<std::int64_t> end_ns_;
    Profile::Counts counts_{};
    std::size_t count_ = 0;
};

}  // namespace lamina
