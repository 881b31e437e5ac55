// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/automatic_transfer.h"

namespace lamina {

// Returns a transfer function for labels (few whole numbers, two or more): the most frequent one is
// transparent, each other has a colour of its own, which ends halfway to its neighbours.
AutomaticTransfer label_transfer(const ValueDistribution& values);

}  // namespace lamina
