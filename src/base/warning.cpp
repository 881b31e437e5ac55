// SPDX-License-Identifier: Apache-2.0
#include "base/warning.h"

#include <mutex>
#include <utility>

namespace lamina {
namespace {

std::mutex taking;
WarningTaker current;

}  // namespace

void warn(const std::string& text) {
    const std::lock_guard lock(taking);
    if (current) current(text);
}

void take_warnings(WarningTaker taker) {
    const std::lock_guard lock(taking);
    current = std::move(taker);
}

}  // namespace lamina
