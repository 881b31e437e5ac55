// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace lamina {

// The message of an exception, for people: one line in which no library speaks. Errors that a user
// can cause have their own words. What the file system refuses is named with the system's reason.
// Any other exception is a mistake of the program, and the line says what to report.
std::string error_text(const std::exception& error);

}  // namespace lamina
