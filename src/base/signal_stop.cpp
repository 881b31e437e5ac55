// SPDX-License-Identifier: Apache-2.0
#include "base/signal_stop.h"

#include <semaphore.h>

#include <atomic>
#include <cassert>
#include <cerrno>

namespace lamina {
namespace {

// A handler has no argument but the signal, so what it uses is global. The semaphore is never
// destroyed, because a handler may still run in another thread when a SignalStop ends.
struct Wake {
    Wake() { sem_init(&semaphore, 0, 0); }
    sem_t semaphore{};
} wake;

std::atomic<int> caught = 0;  // the signal; 0: none
static_assert(std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");
std::atomic<bool> exists = false;

// POSIX names sem_post() among the functions that a signal handler may call.
void on_signal(int signal) {
    const int error_of_interrupted_code = errno;
    caught = signal;
    sem_post(&wake.semaphore);
    errno = error_of_interrupted_code;
}

}  // namespace

SignalStop::SignalStop() {
    [[maybe_unused]] const bool existed = exists.exchange(true);
    assert(!existed);
    caught = 0;
    waiter_ = std::jthread([this](const std::stop_token& ending) {
        while (caught == 0 && !ending.stop_requested()) sem_wait(&wake.semaphore);
        if (caught != 0) source_.request_stop();
    });
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < signals.size(); ++i) {
        sigaction(signals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) sigaction(signals[i], &action, nullptr);
    }
}

SignalStop::~SignalStop() {
    for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
    waiter_.request_stop();
    sem_post(&wake.semaphore);
    waiter_.join();
    exists = false;
}

int SignalStop::exit_code() const {
    return 128 + caught;
}

}  // namespace lamina
