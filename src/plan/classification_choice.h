// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// The largest error of exact segments in float32, in 1/255, where extinction times the length of a
// cell jumps by less than .2 (docs/precision.md).
inline constexpr double exact_segment_error = 0.05;

struct ClassificationChoice {
    Classification classification = Classification::post;  // not automatic
    std::string reason;  // empty where the scene names the classification
};

// The choice of "classification": "auto" for slicing. Throws Error where the context or the filter
// cannot do what the scene asks for.
ClassificationChoice choose_classification(const Scene& scene, const Capabilities& capabilities);

// The scene with a classification and, where exact segments make them equally good, a number of
// slabs: that of the tree, or 1.
Scene with_classification(Scene scene, Classification classification);

}  // namespace lamina
