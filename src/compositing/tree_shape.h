// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lamina {

// Consecutive samples of a ray, or slabs of a volume. Number 0 is the nearest to the eye.
struct SampleSpan {
    int first = 0;
    int count = 0;
    int end() const { return first + count; }
};

// Returns the samples of child i of a node with k children and n samples (docs/numerics.md, section
// 3): from floor(i n / k) up to, but without, floor((i + 1) n / k), counted from the node's first.
// The children's sizes differ by at most one; some are empty if k > n.
SampleSpan child_span(const SampleSpan& node, int child, int children);

// A compositing tree over N samples (LaMar 2004, section 6), given by bifurcation factors from the
// root to the leaves, for any factors and any N >= 1. A node on the last level is a leaf: its
// children are samples. If the product of the factors is less than N, a level is added below.
class TreeShape {
  public:
    TreeShape(const std::vector<int>& factors, int samples);

    int samples() const { return samples_; }
    int levels() const { return static_cast<int>(factors_.size()); }
    int factor(int level) const { return factors_[static_cast<std::size_t>(level)]; }
    SampleSpan root() const { return {0, samples_}; }

    // Tells whether a node is a leaf: on the last level, or on any level with a single sample.
    bool is_leaf(int level, const SampleSpan& node) const {
        return level + 1 == levels() || node.count <= 1;
    }
    // Tells whether a node computed in float is marched: if each of its children is a single
    // sample, it composites these samples in one loop instead of drawing child nodes.
    bool is_marched(int level, const SampleSpan& node) const {
        return is_leaf(level, node) || factor(level) >= node.count;
    }
    // Returns the number of leaves that hold samples.
    std::int64_t leaf_count() const { return count_leaves(0, samples_); }

  private:
    std::int64_t count_leaves(int level, int count) const;

    std::vector<int> factors_;
    int samples_;
};

inline constexpr int max_tree_levels = 16;
inline constexpr int max_tree_factor = 65536;

// Parses factors such as "32x32" or "4^5"; throws Error on anything else.
std::vector<int> parse_factors(const std::string& text);
std::string to_text(const std::vector<int>& factors);

}  // namespace lamina
