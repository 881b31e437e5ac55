// SPDX-License-Identifier: Apache-2.0
// The self-test as released: complete, and passed by the cpu engine.
#include "selftest/selftest.h"

#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "gl/gl_fixture.h"
#include "support/expect_error.h"
#include "tiles/cpu_capabilities.h"

namespace lamina::selftest {
namespace {

// Tells whether the case takes most of the time: one has a million tets. `lamina selftest` draws
// it.
bool is_large(const SelftestCase& each) {
    return each.scene == "hub_1e6";
}

std::vector<SelftestCase> cases_but_the_large(const std::string& group) {
    std::vector<SelftestCase> cases = selftest_cases({group});
    std::erase_if(cases, is_large);
    return cases;
}

class SelftestGroup : public testing::TestWithParam<std::string> {};

TEST_P(SelftestGroup, Passes) {
    const Capabilities capabilities = cpu_capabilities();
    const PictureMaker maker(capabilities);
    for (const SelftestResult& result : run_selftest(cases_but_the_large(GetParam()), maker)) {
        EXPECT_EQ(result.outcome.verdict, Verdict::passed)
            << result.scene << ", " << result.way << ": " << result.outcome.note;
    }
}

INSTANTIATE_TEST_SUITE_P(All, SelftestGroup, testing::ValuesIn(selftest_groups()),
                         [](const auto& group) { return group.param; });

using OpenGlSelftest = gl::EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, OpenGlSelftest, gl::both_contexts, gl::context_name);

// Rays that walk need no order, so no cycle is found.
TEST_P(OpenGlSelftest, AsksForCyclesOnlyIfTetsAreSorted) {
    std::vector<SelftestCase> cases = selftest_cases({"meshes"});
    std::erase_if(cases, [](const SelftestCase& each) { return each.scene != "cyclic"; });
    EXPECT_GE(cases.size(), 2u);
    const PictureMaker maker(capabilities());
    for (const SelftestResult& result : run_selftest(cases, maker))
        EXPECT_EQ(result.outcome.verdict, Verdict::passed)
            << result.way << ": " << result.outcome.note;
}

TEST(Selftest, HasManyCasesUnderDifferentNames) {
    const std::vector<SelftestCase> cases = selftest_cases({});
    EXPECT_GE(cases.size(), 200u);
    std::set<std::string> names;
    for (const SelftestCase& each : cases) {
        EXPECT_TRUE(names.insert(each.name()).second) << each.name();
        EXPECT_FALSE(each.about.empty()) << each.name();
    }
}

TEST(Selftest, RefusesUnknownGroups) {
    EXPECT_THROW(selftest_cases({"optic"}), UsageError);
}

// A case that cannot be drawn is neither passed nor failed, and gives the reason.
TEST(Selftest, ReportsWhatWasRefused) {
    const Capabilities capabilities = cpu_capabilities();
    const PictureMaker maker(capabilities);
    const SelftestCase refused{"g", "s", "w", "about", [](const PictureMaker&) -> CaseOutcome {
                                   fail("no such extension");
                               }};
    const auto results = run_selftest({refused}, maker);
    EXPECT_EQ(results[0].outcome.verdict, Verdict::refused);
    EXPECT_EQ(results[0].outcome.note, "no such extension");
    const auto document = selftest_json(results);
    EXPECT_EQ(document["counts"]["refused"], 1);
    EXPECT_EQ(document["cases"][0]["verdict"], "refused");
    EXPECT_NE(selftest_table(results).find("refused: no such extension"), std::string::npos);
}

}  // namespace
}  // namespace lamina::selftest
