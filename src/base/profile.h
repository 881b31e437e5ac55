// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace lamina {

// Measures the time since it was made.
class Stopwatch {
  public:
    double seconds() const { return 1e-9 * static_cast<double>(now() - start_ns_); }
    double milliseconds() const { return 1e3 * seconds(); }

    // Returns nanoseconds since a fixed, unknown moment, by the clock of all measurements.
    static std::int64_t now() {
        using std::chrono::duration_cast, std::chrono::nanoseconds, std::chrono::steady_clock;
        return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
    }

  private:
    std::int64_t start_ns_ = now();
};

// Records what this process did when, as spans of time on rows: one row for each thread that has a
// Stage, and one for OpenGL. Only one Profile may exist at a time; without one, a Stage is only a
// stopwatch. It keeps the first most_spans spans and counts the others, so that memory is bounded.
class Profile {
  public:
    struct Count {
        const char* name;  // null: none
        double value;
    };
    using Counts = std::array<Count, 4>;

    static constexpr int opengl_row = 0, first_row = 1;  // first_row: the thread that made it
    static constexpr std::size_t most_spans = std::size_t{1} << 18;  // 24 MiB

    // Times come from Stopwatch::now(). Names must be literals: only their pointers are kept.
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

    // Returns the spans in the order in which they ended. No other thread may be working.
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

// A timed stage of work, recorded if a Profile exists. A stage must end in its own thread, and
// those of a thread in the reverse order of their beginnings.
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
