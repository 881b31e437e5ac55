// SPDX-License-Identifier: Apache-2.0
#include "tiles/instruction_set.h"

#include <fmt/ranges.h>
#include <hwy/highway.h>
#include <hwy/targets.h>

#include <algorithm>

#include "base/error.h"

namespace lamina {
namespace {

// Of Highway's targets the lower bit is the better one.
std::vector<std::int64_t> available() {
    std::vector<std::int64_t> targets;
    for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1)
        targets.push_back(left & -left);
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
    return names_of(available());
}

void restrict_instructions(const std::string& name) {
    hwy::DisableTargets(0);
    const std::vector<std::int64_t> targets = available();
    const std::vector<std::string> names = names_of(targets);
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
        throw UsageError(
            fmt::format("instruction set {}: expected one of {}", name, fmt::join(names, ", ")));
    }
    std::int64_t better = 0;
    for (std::ptrdiff_t i = 0; i < found - names.begin(); ++i)
        better |= targets[static_cast<std::size_t>(i)];
    hwy::DisableTargets(better);
    hwy::GetChosenTarget().DeInit();
}

}  // namespace lamina
