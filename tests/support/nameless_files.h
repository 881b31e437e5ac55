// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include "support/temporary_folder.h"

namespace lamina {

// Tells whether files without a name can be made in the folder (O_TMPFILE; not on NFS, for
// example).
inline bool has_nameless_files(const TemporaryFolder& folder) {
    const int descriptor = open(folder.path().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (descriptor >= 0) close(descriptor);
    return descriptor >= 0;
}

}  // namespace lamina
