// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// After this, SIGINT and SIGTERM no longer end the process: they make check_interrupt() throw.
void catch_interrupts();

// Throws Interrupted once a signal has come. Long loops call it; safe from any thread.
void check_interrupt();

}  // namespace lamina
