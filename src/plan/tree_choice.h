// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compositing/codes.h"
#include "compositing/tree_shape.h"
#include "lamina/scene.h"
#include "plan/capabilities.h"

namespace lamina {

// A compositing tree over the slabs of a picture.
struct TreePlan {
    std::vector<int> factors;  // children of a node, for each level from the root to the leaves
    NodeArithmetic nodes = NodeArithmetic::shader;
    NodeCode code = NodeCode::minimax;
    int alpha_bits = 8;
    double largest_color = 1;  // the colour component that images of shader nodes store as 1

    friend bool operator==(const TreePlan&, const TreePlan&) = default;
};

// Facts that the choice of "tree": "auto" depends on.
struct TreeQuestion {
    Target target = Target::float32;
    Emulation emulation;
    int slabs = 1;
    int visible_slabs = 1;  // largest number of visible slabs that are composited on one ray
    Order order = Order::back_to_front;
    std::optional<Dither> dither;  // rounds opacity to codes
    double largest_color = 1;      // largest colour component of what is composited
    double max_error = 1;          // in 1/255, as the scene has it
    double slab_error = 0;  // the share of max_error that the slabs were found to use, in 1/255
};

struct TreeChoice {
    std::optional<TreePlan> tree;  // none: slabs are blended one after the other
    // In 1/255, relative to an exact compositing of these slabs; none for a tree that was given.
    std::optional<double> error_bound;
    std::string reason;
};

// Bounds on the error of the picture, in 1/255 (docs/precision.md derives them).
double straight_error_bound(const TreeQuestion& question);
double one_level_error_bound(const TreeQuestion& question);

// Bounds the error of a plan's compositing by blending (no tree), or by any tree whose nodes' code
// has such a bound: the minimax code of shader nodes. Otherwise none.
std::optional<double> rounding_bound(const TreeQuestion& question,
                                     const std::optional<TreePlan>& tree);

// Chooses between blending and a tree: the cheaper one whose error bound fits into the share of
// max_error that the slabs leave, or, if neither fits, the one with the smaller bound. Throws Error
// if compositing alone exceeds max_error and the scene asks for another target than float32.
TreeChoice choose_tree(const TreeQuestion& question);

// Throws Error if a tree whose factors the scene gives cannot be drawn. `single_color`: everything
// visible has one colour.
void check_slice_tree(const Scene& scene, bool single_color);
void check_project_tree(const Scene& scene, bool single_color);

// Throws Error if a leaf has more than `most` slabs, the limit of the context's loops
// (plan/march_limit.h).
void check_leaves(const Scene& scene, const TreeShape& shape, int most,
                  const Capabilities& capabilities);

}  // namespace lamina
