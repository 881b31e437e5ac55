// SPDX-License-Identifier: Apache-2.0
#include "base/interrupt.h"

#include <atomic>
#include <csignal>
#include <utility>

#include "base/error.h"

namespace lamina {
namespace {

std::atomic<int> caught = 0;  // the signal; 0: none
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

thread_local std::stop_token stop_of_thread;

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
    if (caught.load(std::memory_order_relaxed) != 0 || stop_of_thread.stop_requested())
        throw Interrupted();
}

StopScope::StopScope(std::stop_token stop)
    : before_(std::exchange(stop_of_thread, std::move(stop))) {}

StopScope::~StopScope() {
    stop_of_thread = std::move(before_);
}

std::stop_token StopScope::current() {
    return stop_of_thread;
}

int interrupt_exit_code() {
    return 128 + caught;
}

}  // namespace lamina
