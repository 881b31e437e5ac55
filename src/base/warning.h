// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace lamina {

// Something in a user's data that is no error and that no result shows: the text names the file,
// what was found and what was expected. It goes to the client that this thread works for
// (base/client.h), else to who takes the process's warnings; nobody does at first. Safe from any
// thread.
void warn(const std::string& text);

// Sets the function that receives warnings, in place of the one before; an empty function means
// none.
using WarningTaker = std::function<void(const std::string&)>;
void take_warnings(WarningTaker taker);

}  // namespace lamina
