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

// What happened when in this process, as spans of time on rows: one row for each thread that has
// a Stage, and one for OpenGL. Records from its making to its end; only one does at a time. Where
// none does, a Stage is a stopwatch. Keeps the first most_spans of them and counts the others, so
// that a million frames take no more memory than some ten thousand.
class Profile {
  public:
    struct Count {
        const char* name;  // null: none
        double value;
    };
    using Counts = std::array<Count, 4>;

    static constexpr int opengl_row = 0, first_row = 1;  // first_row: the thread that made it
    static constexpr std::size_t most_spans = std::size_t{1} << 18;  // 24 MiB

    // Times are Stopwatch::now(). Names are literals: they are kept as they are.
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

    // In the order in which they ended; to be asked when no other thread is at work.
    const std::vector<Span>& spans() const { return spans_; }
    std::int64_t spans_left_out() const { return left_out_; }
    int row_count() const;  // OpenGL's among them

  private:
    void keep(const Span& span);  // with adding_ held

    std::mutex adding_;
    std::vector<Span> spans_;
    std::int64_t left_out_ = 0;
    std::map<std::thread::id, int> rows_;
};

}  // namespace lamina
