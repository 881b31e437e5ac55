// SPDX-License-Identifier: Apache-2.0
#include "simd/instruction_set.h"

#include <fmt/ranges.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>

#include "base/error.h"

namespace lamina {
namespace {

std::int64_t left_out = 0;  // targets that restrict_instructions() excludes

// Returns the instruction sets of this machine, as bits of Highway's targets. Highway is asked
// once, because SupportedTargets() makes LAMINA_DISPATCH choose the machine's best target again,
// even if restrict_instructions() excluded it; DeInit() makes it choose anew.
std::int64_t of_machine() {
    static const std::int64_t targets = [] {
        const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
        hwy::GetChosenTarget().DeInit();
        return supported;
    }();
    return targets;
}

// Returns the set bits one by one, the best target first: it has the lowest bit.
std::vector<std::int64_t> listed(std::int64_t all) {
    std::vector<std::int64_t> targets;
    for (std::int64_t left = all; left != 0; left &= left - 1) targets.push_back(left & -left);
    return targets;
}

std::vector<std::string> names_of(const std::vector<std::int64_t>& targets) {
    std::vector<std::string> names;
    for (const std::int64_t target : targets) names.emplace_back(hwy::TargetName(target));
    return names;
}

}  // namespace

std::string instruction_set() {
    return instruction_sets().front();
}

std::vector<std::string> instruction_sets() {
    return names_of(listed(of_machine() & ~left_out));
}

void restrict_instructions(const std::string& name) {
    const std::vector<std::int64_t> targets = listed(of_machine());
    const std::vector<std::string> names = names_of(targets);
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
        throw UsageError(
            fmt::format("instruction set {}: expected one of {}", name, fmt::join(names, ", ")));
    }
    left_out = 0;
    for (std::ptrdiff_t i = 0; i < found - names.begin(); ++i)
        left_out |= targets[static_cast<std::size_t>(i)];
    hwy::DisableTargets(left_out);
    hwy::GetChosenTarget().DeInit();
}

}  // namespace lamina
