// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>

namespace lamina {

// After this call SIGINT, SIGTERM and SIGHUP no longer end the process but make check_interrupt()
// throw. Signals that the caller had set to be ignored (nohup, a shell's background) stay ignored.
void catch_interrupts();

// Throws Interrupted once a signal has arrived, or a stop was requested in the StopScope of this
// thread. Long loops call it. Safe from any thread.
void check_interrupt();

// While it exists, its thread and the tasks of base/parallel.h that the thread starts can be
// stopped through its stop token. Of several scopes in one thread the last one counts.
class StopScope {
  public:
    explicit StopScope(std::stop_token stop);
    ~StopScope();
    StopScope(const StopScope&) = delete;
    StopScope& operator=(const StopScope&) = delete;

    // This thread's stop token, or one that is never stopped where there is no scope.
    static std::stop_token current();

  private:
    std::stop_token before_;
};

// 128 plus the signal's number, as in shells: 130 for Ctrl-C. Valid after Interrupted was thrown.
int interrupt_exit_code();

}  // namespace lamina
