// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include "base/client.h"

#if defined(__SANITIZE_THREAD__)
#define LAMINA_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define LAMINA_THREAD_SANITIZER 1
#endif
#endif

#ifdef LAMINA_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#define LAMINA_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize("thread")))
#else
#define LAMINA_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace lamina {

// Tells the thread sanitizer which order oneTBB guarantees, because oneTBB itself is not built with
// the sanitizer: a task runs after what its caller did before the loop, and the caller goes on
// after all tasks. It states no order between tasks. Without the sanitizer it does nothing.
class HandOver {
  public:
    HandOver() { release(&given_); }
    ~HandOver() { acquire(&returned_); }
    HandOver(const HandOver&) = delete;
    HandOver& operator=(const HandOver&) = delete;

    // Calls `work` as a task. The function that calls this reads the task's captures, which oneTBB
    // may have copied on another core, so it must be marked LAMINA_UNSEEN_BY_THREAD_SANITIZER.
    template <typename Work>
    void task(const Work& work) {
        acquire(&given_);
        const Return at_the_end{this};
        work();
    }

  private:
    struct Return {
        HandOver* hand_over;
        ~Return() { hand_over->release(&hand_over->returned_); }
    };

#ifdef LAMINA_THREAD_SANITIZER
    static void acquire(char* mark) {
        __tsan_acquire(mark);
    }
    static void release(char* mark) {
        __tsan_release(mark);
    }
#else
    static void acquire(char* /*mark*/) {}
    static void release(char* /*mark*/) {}
#endif

    char given_ = 0, returned_ = 0;
};

// Calls body(i) for all i in [0, count) on all cores, in any order. Ends early if a stop is
// requested, or on an exception, which is rethrown. `grain`: calls in a task, for 10 us or longer.
template <typename Body>
void parallel_for(std::int64_t count, std::int64_t grain, const Body& body) {
    HandOver hand_over;
    const Client client = ClientScope::current();
    using Range = tbb::blocked_range<std::int64_t>;
    tbb::parallel_for(Range(0, count, static_cast<std::size_t>(grain)),
                      [&](const Range& range) LAMINA_UNSEEN_BY_THREAD_SANITIZER {
                          const std::int64_t first = range.begin(), end = range.end();
                          hand_over.task([&] {
                              const ClientScope scope(client);
                              check_interrupt();
                              for (std::int64_t i = first; i != end; ++i) body(i);
                          });
                      });
}

// Calls both functions, on two cores if possible. Rethrows an exception after both have ended.
template <typename First, typename Second>
void parallel_invoke(const First& first, const Second& second) {
    HandOver hand_over;
    const Client client = ClientScope::current();
    const auto task = [&](const auto& work) LAMINA_UNSEEN_BY_THREAD_SANITIZER {
        hand_over.task([&] {
            const ClientScope scope(client);
            work();
        });
    };
    tbb::parallel_invoke([&]() LAMINA_UNSEEN_BY_THREAD_SANITIZER { task(first); },
                         [&]() LAMINA_UNSEEN_BY_THREAD_SANITIZER { task(second); });
}

// Sorts on all cores, equal elements in any order. With the thread sanitizer it uses one core:
// HandOver cannot describe how oneTBB's sort passes data between tasks.
template <typename Iterator, typename Less>
void parallel_sort(Iterator begin, Iterator end, const Less& less) {
#ifdef LAMINA_THREAD_SANITIZER
    std::sort(begin, end, less);
#else
    tbb::parallel_sort(begin, end, less);
#endif
}

}  // namespace lamina
