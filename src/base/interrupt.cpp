// SPDX-License-Identifier: Apache-2.0
#include "base/interrupt.h"

#include "base/client.h"
#include "base/error.h"

namespace lamina {

void check_interrupt() {
    if (ClientScope::current().stop.stop_requested()) throw Interrupted();
}

}  // namespace lamina
