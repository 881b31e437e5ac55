// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "base/stopwatch.h"

namespace lamina {

// A record of what happened when in this process, as spans of time on rows. There is one row for
// each thread that has a Stage, and one for OpenGL. A Profile records while it exists, and only one
// records at a time. Where none does, a Stage is a stopwatch. It keeps the first most_spans spans
// and only counts the others, so that its memory is bounded for any number of frames.
class Profile {
  public:
    struct Count {
        const char* name;  // null: none
        double value;
    };
    using Counts = std::array<Count, 4>;

    static constexpr int opengl_row = 0, first_row = 1;  // first_row is the thread that made it
    static constexpr std::size_t most_spans = std::size_t{1} << 18;  // 24 MiB

    // Times come from Stopwatch::now(). Names must be literals, because only their pointers are
    // kept.
    struct Span {
        const char* name;
        std::int64_t begin_ns, end_ns;
        Counts counts;
        int row;
    };

    Profile();
    ~Profile();
    Profile(const Profile&) = delete;
    Profile& operator=(const Profile&) = delete;

    static Profile* recording();  // null: none

    // Safe from any thread.
    void add(const char* name, std::int64_t begin_ns, std::int64_t end_ns, const Counts& counts);
    void add_opengl(const char* name, std::int64_t begin_ns, std::int64_t end_ns);

    // The spans in the order in which they ended. Must be called while no other thread is working.
    const std::vector<Span>& spans() const { return spans_; }
    std::int64_t spans_left_out() const { return left_out_; }
    int row_count() const;  // including OpenGL's row

  private:
    void keep(const Span& span);  // adding_ must be locked

    std::mutex adding_;
    std::vector<Span> spans_;
    std::int64_t left_out_ = 0;
    std::map<std::thread::id, int> rows_;
};

}  // namespace lamina
