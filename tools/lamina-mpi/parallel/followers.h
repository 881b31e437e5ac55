// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parallel/ranks.h"

namespace lamina {

// Does what rank 0's Leader says until that ends. Where a step fails on any rank (agreement.h),
// rank 0 says why, and its exit code is that of the job.
void run_follower(const Ranks& ranks);

}  // namespace lamina
