// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace lamina {

// Return instruction sets of the engine `cpu`: SSE4, AVX2, AVX3 (AVX-512), NEON. Pictures do not
// depend on them: there are no fused multiply-adds and no approximate reciprocals.
std::string instruction_set();                // in use
std::vector<std::string> instruction_sets();  // those that this machine has, the best first

// Excludes all instruction sets better than `name` from now on, for checks. Throws UsageError if
// the machine does not have it. No frame may be drawn during the call.
void restrict_instructions(const std::string& name);

}  // namespace lamina
