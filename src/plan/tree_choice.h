// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compositing/dither.h"
#include "lamina/scene.h"

namespace lamina {

// A compositing tree over the slabs of a picture.
struct TreePlan {
    std::vector<int> factors;  // from the root to the leaves
    NodeArithmetic nodes = NodeArithmetic::shader;
    NodeCode code = NodeCode::minimax;
    int alpha_bits = 8;
    double largest_color = 1;  // that the images of shader nodes stand for as 1

    friend bool operator==(const TreePlan&, const TreePlan&) = default;
};

// What "tree": "auto" decides from.
struct TreeQuestion {
    Target target = Target::float32;
    Emulation emulation;
    int slabs = 1;
    int visible_slabs = 1;  // that are composited on one ray, at most, and can be seen
    Order order = Order::back_to_front;
    std::optional<Dither> dither;  // of codes
    double largest_color = 1;      // component of what is composited
    double max_error = 1;          // in 1/255, as the scene has it
    double slab_error = 0;         // of it, what the slabs were found to take
};

struct TreeChoice {
    std::optional<TreePlan> tree;  // none: blend slab after slab
    double error_bound = 0;        // in 1/255, against the same slabs composited exactly
    std::string reason;
};

// Bounds on the error of the picture, in 1/255 (docs/precision.md derives them).
double straight_error_bound(const TreeQuestion& question);
double one_level_error_bound(const TreeQuestion& question);

// The cheaper of what keeps to what the slabs leave of max_error, else the better. Throws Error
// where compositing alone misses max_error and another target than float32 was asked for.
TreeChoice choose_tree(const TreeQuestion& question);

}  // namespace lamina
