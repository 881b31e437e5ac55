// SPDX-License-Identifier: Apache-2.0
#include "base/warning.h"

#include <mutex>

#include "base/client.h"

namespace lamina {

void warn(const std::string& text) {
    static std::mutex one_at_a_time;
    const WarningTaker* const taker = ClientScope::current().warnings;
    if (taker == nullptr || !*taker) return;
    const std::lock_guard lock(one_at_a_time);
    (*taker)(text);
}

}  // namespace lamina
