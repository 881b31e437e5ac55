// SPDX-License-Identifier: Apache-2.0
#include "compositing/tree_shape.h"

#include <algorithm>
#include <charconv>

#include "base/error.h"

namespace lamina {
namespace {

// Parses a number from 1 to `most`, and moves `at` behind it. `what` names the number in messages.
int parse_whole(const char*& at, const char* end, const char* what, int most,
                const std::string& text) {
    int number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 1 || number > most) {
        fail("found \"{}\", expected {} from 1 to {}, as in 32x32 or 4^5", text, what, most);
    }
    at = stop;
    return number;
}

}  // namespace

SampleSpan child_span(const SampleSpan& node, int child, int children) {
    const auto boundary = [&](int i) {
        return static_cast<int>(std::int64_t{i} * node.count / children);
    };
    return {node.first + boundary(child), boundary(child + 1) - boundary(child)};
}

TreeShape::TreeShape(const std::vector<int>& factors, int samples)
    : factors_(factors), samples_(samples) {
    std::int64_t product = 1;
    for (const int factor : factors) product = std::min(product * factor, std::int64_t{1} << 32);
    if (product < samples) {
        factors_.push_back(static_cast<int>((samples + product - 1) / product));
    }
}

// Counts the leaves below a node of `count` samples, whose children have one of two sizes.
std::int64_t TreeShape::count_leaves(int level, int count) const {
    if (is_leaf(level, {0, count})) return 1;
    const int k = factor(level), larger = count % k, size = count / k;
    std::int64_t leaves = 0;
    if (size > 0) leaves += (k - larger) * count_leaves(level + 1, size);
    if (larger > 0) leaves += larger * count_leaves(level + 1, size + 1);
    return leaves;
}

std::vector<int> parse_factors(const std::string& text) {
    std::vector<int> factors;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        const int factor = parse_whole(at, end, "bifurcation factors", max_tree_factor, text);
        int times = 1;
        if (at < end && *at == '^')
            times = parse_whole(++at, end, "a number of levels", max_tree_levels, text);
        factors.insert(factors.end(), static_cast<std::size_t>(times), factor);
        if (at == end) break;
        if (*at != 'x') fail("found \"{}\", expected factors joined by x, as in 32x32", text);
        ++at;
    }
    if (factors.size() > max_tree_levels) {
        fail("found {} levels in \"{}\", expected at most {}", factors.size(), text,
             max_tree_levels);
    }
    return factors;
}

std::string to_text(const std::vector<int>& factors) {
    std::string text;
    for (const int factor : factors) {
        if (!text.empty()) text += "x";
        text += std::to_string(factor);
    }
    return text;
}

}  // namespace lamina
