// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace lamina {

// Something in a user's data that is no error and that no result shows: the text names the file,
// what was found and what was expected. It goes to the client that this thread works for
// (base/client.h). Safe from any thread; a taker is called in one thread at a time.
using WarningTaker = std::function<void(const std::string&)>;
void warn(const std::string& text);

}  // namespace lamina
