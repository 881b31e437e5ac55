// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/global_control.h>

#include <optional>

#include "parallel/ranks.h"

namespace lamina {

// While it lives, this rank takes its part of the machine's memory and processors: ranks with the
// same set of processors divide it.
class RankResources {
  public:
    explicit RankResources(const Ranks& ranks);

  private:
    std::optional<tbb::global_control> threads_;
};

}  // namespace lamina
