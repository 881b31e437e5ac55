// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

namespace lamina {

// After this, SIGINT, SIGTERM and SIGHUP no longer end the process: they make check_interrupt()
// throw. What the caller had it ignore (nohup, a shell's background) stays ignored.
void catch_interrupts();

// Throws Interrupted once a signal has come, or a stop was requested of the StopScope that this
// thread works for. Long loops call it; safe from any thread.
void check_interrupt();

// While it is there, its thread, and the tasks of base/parallel.h that it starts, work for somebody
// who may request a stop. Of several in one thread the last one counts.
class StopScope {
  public:
    explicit StopScope(std::stop_token stop);
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

    // This thread's; one that nobody stops where there is no scope.
    static std::stop_token current();

  private:
    std::stop_token before_;
};

// 128 and the signal's number, as shells have it: 130 for Ctrl-C. To be asked after Interrupted.
int interrupt_exit_code();

}  // namespace lamina
