// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parallel/ranks.h"

namespace lamina {

// Does what rank 0's Leader says until that ends, and returns the exit code. Where a step fails on
// any rank (agreement.h), rank 0 says why.
int run_follower(const Ranks& ranks);

}  // namespace lamina
