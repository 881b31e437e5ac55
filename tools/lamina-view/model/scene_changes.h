// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "model/revisions.h"

namespace lamina::view {

// Counts on which parts of a scene differ from those of another.
void count_changes(const Scene& before, const Scene& after, Revisions& revisions);

}  // namespace lamina::view
