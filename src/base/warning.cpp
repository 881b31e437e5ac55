// SPDX-License-Identifier: Apache-2.0
#include "base/warning.h"

#include <mutex>
#include <utility>

#include "base/client.h"

namespace lamina {
namespace {

std::mutex taking;
WarningTaker current;

}  // namespace

void warn(const std::string& text) {
    const std::lock_guard lock(taking);
    const WarningTaker* const client = ClientScope::current().warnings;
    const WarningTaker& taker = client != nullptr ? *client : current;
    if (taker) taker(text);
}

void take_warnings(WarningTaker taker) {
    const std::lock_guard lock(taking);
    current = std::move(taker);
}

}  // namespace lamina
