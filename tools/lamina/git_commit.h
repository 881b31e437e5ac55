// SPDX-License-Identifier: Apache-2.0
#pragma once

// Commit that this program was built from: 12 digits, with "-dirty" if files differ from it, or
// "unknown". cmake/GitCommit.cmake writes the definition.
extern const char* const git_commit;
