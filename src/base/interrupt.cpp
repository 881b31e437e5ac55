// SPDX-License-Identifier: Apache-2.0
#include "base/interrupt.h"

#include <atomic>
#include <csignal>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

std::atomic<int> caught = 0;  // the signal; 0: none
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

void on_signal(int signal) {
    caught = signal;
}

}  // namespace

void catch_interrupts() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
    }
}

void check_interrupt() {
    if (caught.load(std::memory_order_relaxed) != 0 || ClientScope::current().stop.stop_requested())
        throw Interrupted();
}

int interrupt_exit_code() {
    return 128 + caught;
}

}  // namespace lamina
