// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

// Marks what programs outside the library may use. All other symbols are hidden from them.
#define LAMINA_API __attribute__((visibility("default")))

namespace lamina {

// Thrown if data are bad, or if the machine cannot do what was asked. The message is one line that
// names the file, the field or line, what was found and what was expected.
class LAMINA_API Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Thrown if a stop was requested before the work was done. The message says whether anything was
// written.
class LAMINA_API Interrupted : public std::runtime_error {
  public:
    Interrupted() : std::runtime_error("interrupted, nothing written") {}
    using std::runtime_error::runtime_error;
};

// Called with the progress of long work: the present activity ("slicing") and its share from 0 to
// 1. Calls come from one thread at a time, which need not be the caller's. The callback must not
// call the session.
using ProgressCallback = std::function<void(const std::string& activity, double share)>;

}  // namespace lamina
