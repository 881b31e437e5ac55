// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "lamina/export.h"

namespace lamina {

// Thrown if data are bad, or if the machine cannot do what was asked. The message is one line that
// names the file, the field or line, what was found and what was expected.
class LAMINA_API Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Thrown if a stop was requested before the work was done. The message says what is left behind.
class LAMINA_API Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted, nothing written") {}
    using std::runtime_error::runtime_error;
};

}  // namespace lamina
