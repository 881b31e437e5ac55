// SPDX-License-Identifier: Apache-2.0
// Files with more data than the header promises are read, and one warning counts the bytes that are
// not used.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "nrrd_files.h"
#include "support/heard_warnings.h"
#include "volume_files/byte_readers.h"

namespace lamina {
namespace {

using testing::bzip2;
using testing::gzip;
using testing::samples_of;

const std::string samples = "abcdefghijklmnopqrstuvwx";

std::string surplus_header(const std::string& encoding, const std::string& more = "") {
    return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: " + encoding + "\n" +
           more + "\n";
}

class NrrdSurplus : public testing::WrittenFiles {
  protected:
    // Returns the warnings of reading a file, and checks that it holds `samples`.
    std::vector<std::string> warnings_of(const std::filesystem::path& path) {
        warnings_.clear();
        const auto found = samples_of<std::uint8_t>(open_nrrd(path));
        EXPECT_EQ(std::string(found.begin(), found.end()), samples);
        return warnings_;
    }

    void expect_warning(const std::string& bytes, std::initializer_list<std::string> parts) {
        const auto warnings = warnings_of(write("a.nrrd", bytes));
        ASSERT_EQ(warnings.size(), 1u);
        expect_says(warnings[0], {"a.nrrd: found ", "of the header: they are not used"});
        expect_says(warnings[0], parts);
    }

  private:
    test::HeardWarnings heard_;
    std::vector<std::string>& warnings_ = heard_.texts;
};

TEST_F(NrrdSurplus, IsNotReportedIfThereIsNone) {
    EXPECT_TRUE(warnings_of(write("a.nrrd", surplus_header("raw") + samples)).empty());
    EXPECT_TRUE(warnings_of(write("a.nrrd", surplus_header("gzip") + gzip(samples))).empty());
    EXPECT_TRUE(warnings_of(write("a.nrrd", surplus_header("bzip2") + bzip2(samples))).empty());
    EXPECT_TRUE(warnings_of(write("a.nrrd", surplus_header("gzip") + gzip(samples.substr(0, 5)) +
                                                gzip(samples.substr(5))))
                    .empty());
    EXPECT_TRUE(warnings_of(write("a.nrrd", surplus_header("bzip2") + bzip2(samples.substr(0, 5)) +
                                                bzip2(samples.substr(5))))
                    .empty());
    // A negative byte skip says that bytes follow the data, so these are no surplus.
    EXPECT_TRUE(
        warnings_of(write("a.nrrd", surplus_header("raw", "byte skip: -4\n") + samples + "xyz"))
            .empty());
}

TEST_F(NrrdSurplus, IsReportedForRawData) {
    expect_warning(surplus_header("raw") + samples + "xyz",
                   {"3 bytes more than the 4 x 3 x 2 uint8 samples"});
    expect_warning(surplus_header("raw", "byte skip: 2\n") + "12" + samples + "\n",
                   {"1 bytes more"});
    write("data.raw", samples + "xy");
    const auto warnings =
        warnings_of(write("a.nhdr", surplus_header("raw", "data file: data.raw\n")));
    ASSERT_EQ(warnings.size(), 1u);
    expect_says(warnings[0], {"data.raw: found 2 bytes more"});
}

TEST_F(NrrdSurplus, IsReportedForHexData) {
    std::string hex;
    for (const char sample : samples) hex += fmt::format("{:02x}", sample);
    EXPECT_TRUE(warnings_of(write("a.nrrd", surplus_header("hex") + hex + "\n")).empty());
    expect_warning(surplus_header("hex") + hex + "0a\n\x1a", {"3 letters of hex data more"});
}

TEST_F(NrrdSurplus, IsReportedForPackedData) {
    expect_warning(surplus_header("gzip") + gzip(samples) + "junk!",
                   {"5 bytes behind its gzip data"});
    expect_warning(surplus_header("gzip") + gzip(samples + "12"),
                   {"found 2 bytes of gzip data more"});
    const std::string member = gzip("more");
    expect_warning(surplus_header("gzip") + gzip(samples) + member,
                   {fmt::format("{} bytes behind its gzip data", member.size())});
    expect_warning(surplus_header("bzip2") + bzip2(samples) + "junk!",
                   {"5 bytes behind its bzip2 data"});
    expect_warning(surplus_header("bzip2") + bzip2(samples + "12"),
                   {"found 2 bytes of bzip2 data more"});
}

// A decompression bomb gives one byte more than are counted.
TEST_F(NrrdSurplus, IsCountedUpToALimit) {
    const std::string bomb(most_counted_surplus + 1, '\0');
    expect_warning(surplus_header("gzip") + gzip(samples + bomb), {"found at least 6"});
}

// Surplus bytes are decompressed up to their checksum, which is missing here.
TEST_F(NrrdSurplus, IsCheckedAsFarAsItIsCounted) {
    const std::string packed = gzip(samples + "12");
    testing::expect_bad(
        write("a.nrrd", surplus_header("gzip") + packed.substr(0, packed.size() - 1)),
        {"truncated gzip data: the checksum is missing"});
}

TEST_F(NrrdSurplus, IsReportedForText) {
    std::string text = surplus_header("ascii");
    for (const char sample : samples) text += std::to_string(sample) + " ";
    EXPECT_TRUE(warnings_of(write("a.nrrd", text + "\n\n")).empty());
    expect_warning(text + "7 8 end\n", {"found 3 numbers or other words more"});
}

}  // namespace
}  // namespace lamina
