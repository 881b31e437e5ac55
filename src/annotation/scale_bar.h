// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "annotation/layout.h"

namespace lamina {

// A length that a scale bar stands for.
struct Scale {
    double length = 0;  // world units: 1, 2 or 5 times a power of ten
    double pixels = 0;
};

// Returns the longest scale of at most `most` pixels: in perspective of the plane through the
// camera's center at a right angle to the view.
Scale scale_of(const Scene& scene, double most);

// Makes a block: a bar and its length. `wanted`: scene.annotations.scale_bar.
// If its camera is automatic, the block has no width.
Block scale_bar(Pen& pen, const Annotation& wanted, const Scene& scene, const AnnotatedData& data);

}  // namespace lamina
