// SPDX-License-Identifier: Apache-2.0
#include "selftest/selftest_case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "base/error.h"
#include "base/unreachable.h"
#include "selftest/case_makers.h"

namespace lamina::selftest {

const char* name_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::passed:
            return "passed";
        case Verdict::failed:
            return "failed";
        case Verdict::refused:
            return "refused";
    }
    unreachable_enum();
}

const std::vector<std::string>& selftest_groups() {
    static const std::vector<std::string> groups{"optics",  "cells", "depth", "meshes",     "views",
                                                 "numbers", "clips", "light", "metamorphic"};
    return groups;
}

std::vector<SelftestCase> selftest_cases(const std::vector<std::string>& groups) {
    static const std::map<std::string, std::vector<SelftestCase> (*)()> makers{
        {"optics", optics_cases}, {"cells", cell_cases},  {"depth", depth_cases},
        {"meshes", mesh_cases},   {"views", view_cases},  {"numbers", number_cases},
        {"clips", clip_cases},    {"light", light_cases}, {"metamorphic", metamorphic_cases}};
    for (const std::string& each : groups) {
        if (!makers.contains(each))
            throw UsageError(fmt::format("--group: found \"{}\", expected one of {}", each,
                                         fmt::join(selftest_groups(), ", ")));
    }
    std::vector<SelftestCase> cases;
    for (const std::string& group : selftest_groups()) {
        if (!groups.empty() && std::ranges::find(groups, group) == groups.end()) continue;
        std::ranges::move(makers.at(group)(), std::back_inserter(cases));
    }
    return cases;
}

}  // namespace lamina::selftest
