// SPDX-License-Identifier: Apache-2.0
#include "base/process.h"

#include <gtest/gtest.h>

#include <csignal>

#include "base/client.h"
#include "base/error.h"

namespace lamina {
namespace {

// Sets the handler of a signal while it exists, and restores the handler before.
class HandlerOf {
  public:
    HandlerOf(int signal, void (*handler)(int))
        : signal_(signal), before_(std::signal(signal, handler)) {}
    ~HandlerOf() { std::signal(signal_, before_); }
    HandlerOf(const HandlerOf&) = delete;
    HandlerOf& operator=(const HandlerOf&) = delete;

  private:
    int signal_;
    void (*before_)(int);
};

void wait_for_stop(const SignalStop& signals) {
    while (!signals.token().stop_requested()) std::this_thread::yield();
}

TEST(SignalStop, EachSignalRequestsAStop) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const HandlerOf usual(signal, SIG_DFL);
        const SignalStop signals;
        const ClientScope scope({.stop = signals.token()});
        EXPECT_NO_THROW(check_interrupt());
        std::raise(signal);
        wait_for_stop(signals);
        EXPECT_THROW(check_interrupt(), Interrupted);
        EXPECT_EQ(signals.exit_code(), 128 + signal);
    }
}

TEST(SignalStop, StopsOnlyWorkThatHasItsToken) {
    const HandlerOf usual(SIGINT, SIG_DFL);
    const SignalStop signals;
    std::raise(SIGINT);
    wait_for_stop(signals);
    EXPECT_NO_THROW(check_interrupt());
}

// Also tests that SignalStop's thread ends with it if no signal came.
TEST(SignalStop, RestoresTheHandlers) {
    static volatile std::sig_atomic_t heard = 0;
    const HandlerOf own(SIGTERM, [](int signal) { heard = signal; });
    { const SignalStop signals; }
    std::raise(SIGTERM);
    EXPECT_EQ(heard, SIGTERM);
    heard = 0;
    const HandlerOf ignored(SIGHUP, SIG_IGN);
    {
        const SignalStop signals;
        std::raise(SIGHUP);
        std::raise(SIGTERM);
        wait_for_stop(signals);
        EXPECT_EQ(signals.exit_code(), 128 + SIGTERM);  // not 128 + SIGHUP: that was ignored
    }
    EXPECT_EQ(heard, 0);
}

}  // namespace
}  // namespace lamina
