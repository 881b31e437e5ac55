// SPDX-License-Identifier: Apache-2.0
#include "study/report_files.h"

#include <gtest/gtest.h>

namespace lamina::study {
namespace {

std::string row_of(const std::string& cell) {
    CsvTable table({"name"});
    table.add_row({cell});
    return table.text().substr(5);
}

TEST(CsvTable, QuotesCellsWithSeparators) {
    EXPECT_EQ(row_of("plain text"), "plain text\n");
    EXPECT_EQ(row_of("a,b"), "\"a,b\"\n");
    EXPECT_EQ(row_of("say \"a\""), "\"say \"\"a\"\"\"\n");
    EXPECT_EQ(row_of("two\nlines"), "\"two\nlines\"\n");
}

TEST(CsvTable, KeepsTextFromBeingAFormula) {
    EXPECT_EQ(row_of("=1+1"), "'=1+1\n");
    EXPECT_EQ(row_of("=HYPERLINK(\"x\",\"y\")"), "\"'=HYPERLINK(\"\"x\"\",\"\"y\"\")\"\n");
    EXPECT_EQ(row_of("+A1"), "'+A1\n");
    EXPECT_EQ(row_of("-A1"), "'-A1\n");
    EXPECT_EQ(row_of("-1+A1"), "'-1+A1\n");
    EXPECT_EQ(row_of("@SUM(A1)"), "'@SUM(A1)\n");
    EXPECT_EQ(row_of("\t=1"), "'\t=1\n");
    EXPECT_EQ(row_of("\r=1"), "\"'\r=1\"\n");
}

TEST(CsvTable, KeepsNumbersAsNumbers) {
    for (const char* const number : {"-1", "-.5", "-1e-300", "-1e-400", "-inf", "12", "-0"})
        EXPECT_EQ(row_of(number), std::string(number) + "\n");
    EXPECT_EQ(row_of(""), "\n");
    EXPECT_EQ(row_of("a=b"), "a=b\n");
}

}  // namespace
}  // namespace lamina::study
