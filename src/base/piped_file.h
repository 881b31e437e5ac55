// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/output_file.h"
#include "base/temporary_file.h"

namespace lamina {

// An output that goes to stdout, which need not be able to seek: it is kept in a temporary file
// until commit() copies it, so that a reader gets all of it or nothing.
class PipedFile : public OutputFile {
  public:
    PipedFile();             // throws Error
    void commit() override;  // throws Error

  private:
    TemporaryFile file_;
};

}  // namespace lamina
