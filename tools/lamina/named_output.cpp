// SPDX-License-Identifier: Apache-2.0
#include "named_output.h"

#include "base/output_file.h"

namespace lamina {

std::unique_ptr<OutputFile> open_named(const std::string& name) {
    if (name == standard_stream) return std::make_unique<PipedFile>();
    return std::make_unique<AtomicFile>(name);
}

}  // namespace lamina
