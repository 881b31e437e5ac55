// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// After this call SIGINT, SIGTERM and SIGHUP no longer end the process but make check_interrupt()
// throw. Signals that the caller had set to be ignored (nohup, a shell's background) stay ignored.
void catch_interrupts();

// Throws Interrupted once a signal has come, or the client that this thread works for
// (base/client.h) has requested a stop. Long loops call it; safe from any thread.
void check_interrupt();

// 128 and the signal's number, as shells have it: 130 for Ctrl-C. To be asked after Interrupted.
int interrupt_exit_code();

}  // namespace lamina
