// SPDX-License-Identifier: Apache-2.0
#pragma once

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

// Tells the thread sanitizer what oneTBB guarantees, which it cannot see in a library that was
// built without it: a task runs after what its caller did before the loop, and the caller goes on
// after all tasks. It claims no order between tasks, so that races among them are found. In every
// other build it is empty.
class HandOver {
  public:
    HandOver() { release(&given_); }
    ~HandOver() { acquire(&returned_); }
    HandOver(const HandOver&) = delete;
    HandOver& operator=(const HandOver&) = delete;

    // Calls `work` as a task. The calling function reads the task's captures, which oneTBB may have
    // copied on another core. So it must be marked LAMINA_UNSEEN_BY_THREAD_SANITIZER.
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

}  // namespace lamina
