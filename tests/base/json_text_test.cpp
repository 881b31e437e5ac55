// SPDX-License-Identifier: Apache-2.0
#include "base/json_text.h"

#include <gtest/gtest.h>
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "base/client.h"
#include "base/process.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

std::string repeated(const std::string& text, std::size_t times) {
    std::string whole;
    whole.reserve(text.size() * times);
    for (std::size_t i = 0; i < times; ++i) whole += text;
    return whole;
}

// Returns a JSON list of `count` copies of an element.
std::string list_of(const std::string& element, std::size_t count) {
    return fmt::format("[{}{}]", repeated(element + ",", count - 1), element);
}

std::string nested(std::size_t depth) {
    return repeated("[", depth) + repeated("]", depth);
}

// The parser of nlohmann's library, which has no limits, serves as the oracle.
TEST(JsonText, ParsesDocumentsAsNlohmannsLibraryDoes) {
    for (const char* text :
         {"null", "true", "-7", "18446744073709551615", "0.1", "1e-320", R"("é☃\n")", "[]", "{}",
          R"([1, [2, {"a": {}, "b": [[], null]}], "x", -0.0])",
          R"({"a": {"b": {"c": [1, 2]}, "d": 3}, "e": "f", "": false})", "\xEF\xBB\xBF[1]"}) {
        EXPECT_EQ(parse_json(text), nlohmann::json::parse(text)) << text;
    }
}

TEST(JsonText, MistakesAreReportedWithLineAndColumn) {
    expect_error([] { parse_json("{\"version\": 1,\n \"volume\" }"); }, {"line 2", "column"});
    expect_error([] { parse_json(""); }, {"line 1", "column 1"});
    expect_error([] { parse_json("[\n1e999]"); }, {"line 2, column ", "1e999"});
    expect_error([] { parse_json("\"\xff\""); }, {"UTF-8"});
    EXPECT_THROW(parse_json("[1] 2"), JsonSyntaxError);
    expect_error([] { parse_json("{\"a\": 1,\n \"b\": {\"c\": 1, \"c\": 2}}"); },
                 {"line 2", "column 18", "\"c\"", "twice"});
    // Messages do not repeat long words and keys.
    const std::string word(100'000, 'x');
    EXPECT_LT(error_of([&] { parse_json(fmt::format("[\"{}", word)); }).size(), 250u);
    EXPECT_LT(error_of([&] { parse_json(fmt::format(R"({{"{0}":1,"{0}":2}})", word)); }).size(),
              250u);
}

TEST(JsonText, LimitsTheDepthAndTheNumberOfValues) {
    EXPECT_EQ(parse_json(nested(most_json_depth)), nlohmann::json::parse(nested(most_json_depth)));
    expect_error([] { parse_json(fmt::format("[\n{}]", nested(most_json_depth))); },
                 {"line 2, column 64: nested more than 64 deep"});
    expect_error([] { parse_json(repeated("[", 1'000'000)); }, {"nested more than 64"});
    expect_error([] { parse_json(repeated("{\"a\":", 1'000'000)); }, {"nested more than 64"});
    // The list itself counts as a value.
    EXPECT_EQ(parse_json(list_of("0", most_json_values - 1)).size(), most_json_values - 1);
    expect_error([] { parse_json(list_of("0", most_json_values)); },
                 {"line 1", "more than 10000000 values"});
}

// If the list were searched after each of its objects, these would take an hour.
TEST(JsonText, LongListsOfObjectsTakeLinearTime) {
    EXPECT_EQ(parse_json(list_of("{}", 1'000'000)).size(), 1'000'000u);
    EXPECT_EQ(parse_json(list_of("[]", 1'000'000)).size(), 1'000'000u);
}

// Parses a long list. A timer of processor time sends the signal in the middle of it.
void parse_until_a_signal_comes() {
    const std::string text = list_of("{}", most_json_values - 1);
    std::signal(SIGTERM, SIG_DFL);
    const SignalStop signals;
    const ClientScope scope({.stop = signals.token()});
    std::signal(SIGPROF, [](int) { raise(SIGTERM); });
    const itimerval soon{{0, 0}, {0, 20'000}};
    setitimer(ITIMER_PROF, &soon, nullptr);
    try {
        parse_json(text);
    } catch (const Interrupted&) {
        _exit(signals.exit_code());
    }
    _exit(1);
}

TEST(JsonTextDeathTest, ParsingStopsAtASignal) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(parse_until_a_signal_comes(), testing::ExitedWithCode(128 + SIGTERM), "");
}

TEST(JsonText, UnreadableFilesAreNamedInErrors) {
    const TemporaryFolder folder;
    expect_error([&] { load_json(folder / "none.json"); }, {"none.json", "no such file"});
    expect_error([&] { load_json(folder.path()); }, {"not a file"});
    write_bytes_to(folder / "huge.json", "");
    std::filesystem::resize_file(folder / "huge.json", most_json_bytes + 1);
    expect_error([&] { load_json(folder / "huge.json"); }, {"huge.json", "67108865", "67108864"});
    write_bytes_to(folder / "twice.json", R"({"a": 1, "a": 2})");
    expect_error([&] { load_json(folder / "twice.json"); }, {"twice.json: line 1, column "});
}

}  // namespace
}  // namespace lamina
