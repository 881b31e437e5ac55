// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

#include <array>
#include <stop_token>
#include <thread>

namespace lamina {

// While it exists, SIGINT, SIGTERM and SIGHUP do not end the process but request a stop of its
// token. Signals that were set to be ignored before (nohup, a shell's background) stay ignored.
// Programs make one and work within a ClientScope with its token. Only one may exist at a time.
// Throws std::system_error where its thread cannot be started.
class SignalStop {
  public:
    SignalStop();
    ~SignalStop();
    SignalStop(const SignalStop&) = delete;
    SignalStop& operator=(const SignalStop&) = delete;

    std::stop_token token() const { return source_.get_token(); }

    // 128 and the signal's number, as shells have it: 130 for Ctrl-C. Valid once a stop is
    // requested.
    int exit_code() const;

  private:
    static constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

    std::stop_source source_;
    // stop_source::request_stop() takes a lock, which a signal handler must not do: this thread
    // calls it.
    std::jthread waiter_;
    std::array<struct sigaction, signals.size()> before_{};
};

}  // namespace lamina
