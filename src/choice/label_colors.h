// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "choice/automatic_transfer.h"

namespace lamina {

// A transfer function for labels, which are few whole numbers: the one that most of the field has
// is transparent, each of the others has a colour of its own, halfway to its neighbours. There are
// two or more.
AutomaticTransfer label_transfer(const ValueDistribution& values);

}  // namespace lamina
