// SPDX-License-Identifier: Apache-2.0
#include "study/report_files.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <string_view>

namespace lamina::study {
namespace {

using Json = nlohmann::ordered_json;

const std::string hostile = "</script><img src=x onerror=\"alert(1)\"> & {{title}} <!--";

Json report_named(const std::string& title) {
    return {{"title", title},
            {"kind", "study"},
            {"findings", {"first & last", "a < b"}},
            {"comparisons", Json::array()}};
}

std::size_t count_of(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        ++found;
    }
    return found;
}

// Returns the text between `before` and `after`.
std::string part_of(const std::string& page, const std::string& before, const std::string& after) {
    const std::size_t from = page.find(before) + before.size();
    return page.substr(from, page.find(after, from) - from);
}

std::string document_in(const std::string& page) {
    return part_of(page, R"(<script type="application/json" id="document">)", "</script>");
}

TEST(ReportPage, ShowsTitleAndFindingsWithoutScripts) {
    const std::string page = report_page(report_named("Error & time"));
    EXPECT_EQ(part_of(page, "<title>", "</title>"), "Error &amp; time");
    EXPECT_EQ(part_of(page, "<h1>", "</h1>"), "Error &amp; time");
    EXPECT_EQ(part_of(page, "<ul>\n", "</ul>"), "<li>first &amp; last</li>\n<li>a &lt; b</li>\n");
    EXPECT_EQ(count_of(page, "<noscript>"), 1u);
}

TEST(ReportPage, HoldsTheDocumentWhateverItsStrings) {
    Json report = report_named(hostile);
    report["findings"] = {hostile};
    report["comparisons"] = {{{"scene", hostile}}};
    report[hostile] = {1.5, nullptr, true, "\xe2\x80\xa8", "{{page.js}}"};
    const std::string page = report_page(report);
    EXPECT_EQ(Json::parse(document_in(page)), report);
    EXPECT_EQ(page.find("<img"), std::string::npos);
    // There are two <script> elements on every page: the document and the module.
    EXPECT_EQ(count_of(page, "<script"), 2u);
    EXPECT_EQ(count_of(page, "</script"), 2u);
    EXPECT_EQ(count_of(page, "<!--"), 1u);  // the licence
    EXPECT_EQ(part_of(page, "<h1>", "</h1>"),
              "&lt;/script&gt;&lt;img src=x onerror=\"alert(1)\"&gt; &amp; {{title}} &lt;!--");
}

TEST(ReportPage, ReplacesWhatIsNotUtf8) {
    Json report = report_named("broken \xff title");
    report["findings"] = {"\xc3"};
    const std::string page = report_page(report);
    EXPECT_EQ(part_of(page, "<h1>", "</h1>"), "broken \xef\xbf\xbd title");
    EXPECT_EQ(Json::parse(document_in(page))["findings"][0], "\xef\xbf\xbd");
}

TEST(ReportPage, ShowsControlCharactersAsSuch) {
    Json report = report_named("a\x1b[31m b\x7f");
    report["findings"] = {"bell\a, new\nline, tab\t, CSI \xc2\x9b"};
    report["comparisons"] = {{{"scene", "s\x1b]0;t\a"}, {"k\x1b", 1}}};
    const std::string page = report_page(report);
    EXPECT_EQ(part_of(page, "<h1>", "</h1>"), "a\\x1b[31m b\\x7f");
    EXPECT_EQ(part_of(page, "<ul>\n", "</ul>"),
              "<li>bell\\x07, new\\nline, tab\\t, CSI \\xc2\\x9b</li>\n");
    const Json shown = Json::parse(document_in(page))["comparisons"][0];
    EXPECT_EQ(shown, Json({{"scene", "s\\x1b]0;t\\x07"}, {"k\\x1b", 1}}));
    for (const char c : page)
        EXPECT_TRUE(static_cast<unsigned char>(c) >= ' ' || c == '\n') << static_cast<int>(c);
}

TEST(ReportPage, LinksFindingsToTheirSections) {
    Json report = report_named("t");
    report["summary"] = "2 of 3 < all";
    report["findings"] = {{{"anchor", "table_1"}, {"text", "a < b"}}};
    const std::string page = report_page(report);
    EXPECT_EQ(part_of(page, "<ul>\n", "</ul>"),
              "<li><a href=\"#table_1\">table_1</a>: a &lt; b</li>\n");
    EXPECT_EQ(part_of(page, "<p id=\"summary\">", "</p>"), "2 of 3 &lt; all");
    EXPECT_EQ(report_page(report_named("t")).find("id=\"summary\""), std::string::npos);
}

TEST(ReportPage, HasAllOfItsFilesWithinAndNothingElse) {
    const std::string page = report_page(report_named("t"));
    EXPECT_EQ(page.find("{{"), std::string::npos);
    std::size_t files = 0;
    for (const EmbeddedFile& file : embedded_report_files()) {
        if (file.name == "page.html") continue;
        ++files;
        EXPECT_EQ(count_of(page, std::string(file.text)), 1u) << file.name;
    }
    EXPECT_GE(files, 3u);
    // The page has one address only: the name space of SVG elements, which browsers do not fetch.
    const std::regex address(R"([a-z]+://[^"'\s)]*)");
    std::set<std::string> addresses;
    for (std::sregex_iterator m(page.begin(), page.end(), address), end; m != end; ++m) {
        addresses.insert(m->str());
    }
    EXPECT_EQ(addresses, std::set<std::string>{"http://www.w3.org/2000/svg"});
    for (const char* word : {"@import", "url(", "import(", "fetch(", "XMLHttpRequest", "eval("}) {
        EXPECT_EQ(page.find(word), std::string::npos) << word;
    }
}

TEST(ReportPage, ForbidsTheNetwork) {
    const std::string page = report_page(report_named("t"));
    const std::string policy = part_of(page, "Content-Security-Policy\"\n      content=\"", "\"");
    EXPECT_EQ(policy,
              "default-src 'none'; img-src data:; style-src 'unsafe-inline'; "
              "script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'");
    EXPECT_LT(page.find("Content-Security-Policy"), page.find("<link"));
}

TEST(ReportPage, NeedsTitleAndFindings) {
    Json report = report_named("t");
    report.erase("findings");
    EXPECT_THROW(report_page(report), Json::out_of_range);
}

// Scripts must not make markup from text, or a report's text could act; nor may they contain what
// ends their own element.
TEST(ReportFiles, MakeNoMarkupFromText) {
    for (const EmbeddedFile& file : embedded_report_files()) {
        if (!file.name.ends_with(".js")) continue;
        for (const char* word : {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write",
                                 "</script", "<!--"}) {
            EXPECT_EQ(file.text.find(word), std::string_view::npos) << file.name << ": " << word;
        }
    }
}

}  // namespace
}  // namespace lamina::study
