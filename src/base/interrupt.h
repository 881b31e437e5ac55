// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// Throws Interrupted once the client that this thread works for (base/client.h) has requested a
// stop: the caller of a library's function, or a signal (base/signal_stop.h). Long loops call it;
// safe from any thread.
void check_interrupt();

}  // namespace lamina
