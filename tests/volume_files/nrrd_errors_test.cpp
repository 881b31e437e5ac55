// SPDX-License-Identifier: Apache-2.0
// Bad NRRD files of every kind. Each error is one line that names the file, what was found and what
// was expected.
#include <gtest/gtest.h>

#include <limits>

#include "nrrd_files.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

using testing::bytes_of_values;
using testing::bzip2;
using testing::expect_bad;
using testing::gzip;
using NrrdErrors = testing::WrittenFiles;

const std::string good = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n";

// Returns `good` with the line of one field replaced.
std::string with(const std::string& field, const std::string& line) {
    std::string text = good;
    const auto begin = text.find(field + ":");
    return text.replace(begin, text.find('\n', begin) + 1 - begin, line);
}

TEST_F(NrrdErrors, NameAMissingFile) {
    expect_bad(folder() / "none.nrrd", {"none.nrrd", "no such file"});
    expect_bad(folder(), {"not a regular file"});
}

TEST_F(NrrdErrors, ReportGarbageInPlaceOfAHeader) {
    expect_bad(write("a.nrrd", ""), {"a.nrrd: not a NRRD file"});
    expect_bad(write("a.nrrd", "P5 10000 10000 255\n"), {"not a NRRD file"});
    expect_bad(write("a.nrrd", std::string(100000, '\x80')), {"not a NRRD file"});
    expect_bad(write("a.nrrd", "NRRD0004\n\x01\x02\n\n"), {"line 2"});
    expect_bad(write("a.nrrd", "NRRD0004\nnonsense\n\n"), {"bad NRRD header", "nonsense"});
    expect_bad(write("a.nrrd", "NRRD0004\n# " + std::string(1 << 21, 'x') + "\n\n"),
               {"does not end"});
    expect_bad(write("a.nrrd", good), {"without an empty line"});
}

TEST_F(NrrdErrors, NameMissingAndBadFields) {
    const std::string data(24, 'x');
    for (const std::string field : {"type", "dimension", "sizes", "encoding"}) {
        expect_bad(write("a.nrrd", with(field, "") + "\n" + data), {field});
    }
    expect_bad(write("a.nrrd", with("type", "type: int16\n") + "\n" + data + data), {"endian"});
    expect_bad(write("a.nrrd", with("sizes", "sizes: 4 three 2\n") + "\n" + data), {"sizes"});
    expect_bad(write("a.nrrd", with("sizes", "sizes: 4 0 2\n") + "\n" + data), {"sizes"});
    for (const std::string sizes : {"4 -3 2", "4 3.9 2", "18446744073709551616 1 1"}) {
        expect_bad(write("a.nrrd", with("sizes", "sizes: " + sizes + "\n") + "\n" + data),
                   {"a.nrrd", "line 4", "sizes: found '" + sizes + "'", "whole numbers"});
    }
    for (const std::string spacings : {"1 0 1", "1 1 -2", "1 1 inf", "1 1 -0", "1 1 one"}) {
        expect_bad(write("a.nrrd", good + "spacings: " + spacings + "\n\n" + data),
                   {"a.nrrd", "line 6", "spacings: found '" + spacings + "'", "above 0"});
    }
    for (const std::string spacings : {"1 1 nan", "NaN NaN NaN"}) {
        expect_bad(write("a.nrrd", good + "spacings: " + spacings + "\n\n" + data),
                   {"a.nrrd", "spacings: found nan for axis", "above 0"});
    }
    expect_bad(write("a.nrrd", good + "type: uint8\n\n" + data), {"type"});
}

// teem would print lines with errors into buffers of some 1000 bytes. Remarks, which it never sees,
// may be long.
TEST_F(NrrdErrors, RefuseLongLinesOfFields) {
    for (const std::string field : {"axis mins: ", "labels: ", "foo: ", "kinds: ", "no colon "}) {
        std::string line = field;
        for (int i = 0; i < 485; ++i) line += "1 ";
        expect_bad(write("a.nrrd", good + line + "\n\n" + std::string(24, 'x')),
                   {"a.nrrd", "line 6", std::to_string(line.size()), "at most 512"});
    }
    const std::string remark = std::string(4000, 'x') + "\n";
    const auto path = write("a.nrrd", good + "# " + remark + "content: " + remark +
                                          "key:=" + remark + "\n" + std::string(24, 'x'));
    EXPECT_NO_THROW(open_nrrd(path));
}

TEST_F(NrrdErrors, NameUnsupportedTypesAndEncodings) {
    const std::string data(24 * 8, 'x');
    expect_bad(
        write("a.nrrd", with("type", "type: block\nblock size: 3\nendian: little\n") + "\n" + data),
        {"'block'", "expected a type of numbers"});
    expect_bad(write("a.nrrd", with("encoding", "encoding: hex\n") + "\n" + "00 1x"),
               {"hex data", "enough for at most 2 bytes"});
    const std::string digits = "00 01\n02030405 0607 08090a0b0C0D0E0F 1011121314151617";
    const std::string hex = with("encoding", "encoding: hex\n") + "\n";
    const Volume volume = open_nrrd(write("h.nrrd", hex + digits + "\n"));
    for (int i = 0; i < 24; ++i)
        EXPECT_EQ(static_cast<const unsigned char*>(volume.data())[i], i) << i;
    expect_bad(write("a.nrrd", hex + digits.substr(0, 45) + "zz" + digits),
               {"damaged hex data: found byte 122"});
    const std::string blanks(99, ' ');
    expect_bad(write("a.nrrd", hex + "0001" + blanks), {"found 2 bytes of hex data, expected 24"});
}

TEST_F(NrrdErrors, NameBadDirectionsOfTwoAxes) {
    const auto expect_bad_with = [&](const std::string& directions,
                                     std::initializer_list<std::string> said) {
        expect_bad(write("a.nrrd",
                         "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 4 3\nencoding: raw\n"
                         "space dimension: 2\nspace directions: " +
                             directions + "\n\n" + std::string(12, 'x')),
                   said);
    };
    expect_bad_with("(1,0) none", {"space directions: axis 1 has none", "expected two"});
    expect_bad_with("none (1,0)", {"space directions: axis 0 has none", "expected two"});
    for (const char* const parallel : {"(1,0) (2,0)", "(0,1) (0,-2)", "(.1,.3) (.2,.6)"})
        expect_bad_with(parallel, {"space directions: axes 0 and 1 meet at"});
    expect_bad_with("(1,0) (0,0)", {"axis 1: found a distance of 0"});
}

TEST_F(NrrdErrors, RefuseWhatHasNotThreeAxes) {
    expect_bad(write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 1\nsizes: 12\nencoding: raw\n\n" +
                                   std::string(12, 'x')),
               {"found 1 axes", "expected 3"});
    expect_bad(
        write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 4 3 2\nencoding: raw\n\n" +
                            std::string(72, 'x')),
        {"found 4 axes", "3 4 3 2"});
    expect_bad(write("a.nrrd", good + "kinds: vector domain domain\n\n" + std::string(24, 'x')),
               {"vector"});
}

TEST_F(NrrdErrors, RefuseDirectionsThatMakeNoGrid) {
    const auto directions = [&](const std::string& text) {
        return write("a.nrrd", good + "space dimension: 3\nspace directions: " + text + "\n\n" +
                                   std::string(24, 'x'));
    };
    expect_bad(directions("(1,0,0) (1,1,0) (0,0,1)"),
               {"axes 0 and 1 meet at 45.0000 degrees", "expected 90"});
    expect_bad(directions("(1,0,0) (0,1,0) (0,0.002,1)"), {"axes 1 and 2 meet at 89.88"});
    expect_bad(directions("(1,0,0) (0,1,0) none"), {"axis 2"});
    expect_bad(directions("(1,0,0) (0,0,0) (0,0,1)"), {"axis 1"});
    expect_bad(directions("(1,0,0) (0,1e300,0) (0,0,1)"),
               {"axis 1", "distance of 1e+300", "expected one from 1e-100 to 1e+100"});
    expect_bad(directions("(1,0,0) (0,1e-200,0) (0,0,1)"), {"axis 1", "distance of 1e-200"});
    expect_bad(directions("(1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,1e150,0)"),
               {"space origin", "found 1e+150", "up to 1e+100"});
    expect_bad(directions("(1,0,0) (0,inf,0) (0,0,1)"), {"a.nrrd"});
}

TEST_F(NrrdErrors, RefuseMoreVoxelsThanTheFileHas) {
    const std::string size = "sizes: 1048576 1048576 1\n";  // 2^40
    for (const std::string encoding : {"raw", "gzip", "bzip2", "ascii"}) {
        const std::string text =
            "NRRD0004\ntype: uint8\ndimension: 3\n" + size + "encoding: " + encoding + "\n\n";
        expect_bad(write("a.nrrd", text + std::string(1000, '1')),
                   {"a.nrrd", "1048576 x 1048576 x 1", "1000 bytes"});
        write("data.bin", std::string(1000, '1'));
        const std::string detached = text.substr(0, text.size() - 1) + "data file: data.bin\n";
        expect_bad(write("b.nhdr", detached), {"b.nhdr", "data.bin"});
    }
    const std::string huge = with("sizes", "sizes: 4294967296 4294967296 4294967296\n");
    expect_bad(write("a.nrrd", huge + "\n"), {"a.nrrd"});
}

TEST_F(NrrdErrors, ReportTruncatedData) {
    const std::string text = with("encoding", "encoding: gzip\n") + "\n";
    const std::string packed = gzip("abcdefghijklmnopqrstuvwx");
    open_nrrd(write("a.nrrd", text + packed));
    for (std::size_t length = 3; length < packed.size(); ++length) {
        expect_bad(write("a.nrrd", text + packed.substr(0, length)), {"truncated gzip"});
    }
    expect_bad(write("a.nrrd", text + gzip("abc")), {"found 3 bytes, expected 24"});
    expect_bad(write("a.nrrd", good + "\n" + std::string(23, 'x')), {"(24 bytes)", "23 bytes"});
}

TEST_F(NrrdErrors, ReportTruncatedBzip2) {
    const std::string text = with("encoding", "encoding: bzip2\n") + "\n";
    const std::string packed = bzip2("abcdefghijklmnopqrstuvwx");
    open_nrrd(write("a.nrrd", text + packed));
    for (std::size_t length = 3; length < packed.size(); ++length) {
        expect_bad(write("a.nrrd", text + packed.substr(0, length)),
                   {"a.nrrd: truncated bzip2 data"});
    }
    expect_bad(write("a.nrrd", text + bzip2("abc")), {"found 3 bytes, expected 24"});
}

TEST_F(NrrdErrors, ReportDamagedBzip2) {
    const std::string text = with("encoding", "encoding: bzip2\n") + "\n";
    std::string packed = bzip2("abcdefghijklmnopqrstuvwx");
    packed[packed.size() - 4] =
        static_cast<char>(packed[packed.size() - 4] ^ 1);  // in the file's checksum
    expect_bad(write("a.nrrd", text + packed), {"damaged bzip2 data", "checksum"});
    expect_bad(write("a.nrrd", text + std::string(100, 'x')),
               {"damaged bzip2 data: no bzip2 header"});
}

TEST_F(NrrdErrors, ReportDamagedGzip) {
    const std::string text = with("encoding", "encoding: gzip\n") + "\n";
    std::string packed = gzip("abcdefghijklmnopqrstuvwx");
    packed[packed.size() - 6] =
        static_cast<char>(packed[packed.size() - 6] ^ 1);  // in the checksum
    expect_bad(write("a.nrrd", text + packed), {"damaged gzip"});
    expect_bad(write("a.nrrd", text + std::string(100, 'x')), {"damaged gzip"});
}

TEST_F(NrrdErrors, NameTheBadSampleOfText) {
    const std::string text =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 1 1\nencoding: ascii\n\n";
    expect_bad(write("a.nrrd", text + "1 2       \n"), {"found 2 samples, expected 3"});
    expect_bad(write("a.nrrd", text + "1 two 3\n"), {"sample 2 of 3", "'two'", "uint8"});
    expect_bad(write("a.nrrd", text + "1 2 256\n"),
               {"'256'", "a whole number of type uint8, from 0 to 255"});
    expect_bad(write("a.nrrd", text + "1 2.5 3\n"), {"'2.5'"});
    expect_bad(write("a.nrrd", text + "1 nan 3\n"), {"'nan'"});
    expect_bad(write("a.nrrd", text + std::string(1 << 20, '7')), {"sample 1 of 3"});
}

// teem calls fields missing that it cannot read; lamina's messages must not.
TEST_F(NrrdErrors, DoNotCallPresentFieldsMissing) {
    const std::string sizes = "1000000000 1000000000 1000000000";
    expect_bad(write("a.nrrd", with("sizes", "sizes: " + sizes + "\n") + "\n"),
               {"a.nrrd: line 4: sizes: found '" + sizes + "', expected at most 2^62 samples"});
    for (const std::string dimension : {"17", "0", "-3", "3.5", "three", "4294967299"}) {
        const std::string line = "dimension: " + dimension + "\n";
        expect_bad(write("a.nrrd", with("dimension", line) + "\n"),
                   {"a.nrrd: line 3: dimension: found '" + dimension + "', expected 3"});
    }
    expect_bad(write("a.nrrd", with("sizes", "sizes: 4 3\n") + "\n"), {"sizes"});
}

// teem would take 2^32 for 0, and "1 2" for 1.
TEST_F(NrrdErrors, RefuseSkipsThatAreNoNumbers) {
    const std::string data(24, 'x');
    for (const std::string skip : {"4294967296", "4294967297", "-1", "1.5", "1 2", "x"}) {
        expect_bad(write("a.nrrd", good + "line skip: " + skip + "\n\n" + data),
                   {"a.nrrd: line 6: line skip: found '" + skip + "', expected a whole number"});
    }
    for (const std::string skip : {"18446744073709551616", "9223372036854775807", "1.5", "x"}) {
        expect_bad(write("a.nrrd", good + "byte skip: " + skip + "\n\n" + data),
                   {"a.nrrd: line 6: byte skip: found '" + skip + "', expected a whole number"});
    }
}

// A number below half the smallest float above zero, that is below 7.006e-46, is rounded to 0.
TEST_F(NrrdErrors, SmallNumbersAreRounded) {
    const auto path = write("a.nrrd",
                            "NRRD0004\ntype: float\ndimension: 3\nsizes: 3 2 1\nencoding: ascii\n\n"
                            "1e-5000 -1e-400 1e-45 7e-46 1e-40 3.4028235e38\n");
    constexpr float least = std::numeric_limits<float>::denorm_min();
    EXPECT_EQ(testing::samples_of<float>(open_nrrd(path)),
              (std::vector<float>{0, -0.f, least, 0, 1e-40f, std::numeric_limits<float>::max()}));
}

TEST_F(NrrdErrors, LargeNumbersAreRefused) {
    for (const std::string number : {"1e50", "-1e50", "1e400", "1e5000", "3.5e38"}) {
        const auto path = write(
            "a.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 1 1\nencoding: ascii\n\n" +
                          number + "\n");
        expect_bad(path,
                   {"a.nrrd: sample 1 of 1: found '" + number +
                    "', expected a number of type float, from -3.4028235e+38 to 3.4028235e+38"});
    }
}

TEST_F(NrrdErrors, NameDataFilesThatCannotBeUsed) {
    const auto data_file = [&](const std::string& name) {
        return write("a.nhdr", good + "data file: " + name + "\n");
    };
    expect_bad(data_file("none.raw"), {"none.raw", "a.nhdr", "no such file"});
    expect_bad(data_file("."), {"not a regular file"});
    expect_bad(data_file("/dev/zero"), {"not a regular file"});
    expect_bad(data_file("-"), {"expected a file name"});
    for (const std::string pattern :
         {"%s%s%n.raw 0 10 1", "%d%d.raw 0 10 1", "%.raw 0 10 1", "%3x.raw 0 10 1", "%03d.raw 0 10",
          "%999d.raw 0 10 1", "%03d.raw 0 ten 1"}) {
        expect_bad(data_file(pattern),
                   {"a.nhdr: line 6: data file: found '" + pattern.substr(0, 5), "one %d or %03d"});
    }
    for (const std::string steps : {"0 10 0", "0 10 -1", "0 1000000 1", "0 9223372036854775807 1"})
        expect_bad(data_file("%d.raw " + steps), {"at most 100000 files"});
    expect_bad(data_file("%d.raw 0 4 1"), {"found 5 files, expected 2, of 2 axes each"});
    expect_bad(data_file("%d.raw 0 4 2 1"), {"found 3 files, expected 6, of 1 axes each"});
    expect_bad(data_file("%d.raw 1 2 1"), {"1.raw", "no such file"});
    expect_bad(data_file("LIST"), {"no names after LIST"});
    expect_bad(data_file("LIST three\na.raw"), {"found 'LIST three'", "a number of axes"});
    expect_bad(data_file("LIST\na.raw\nb.raw\nc.raw"), {"found 3 files, expected 2"});
}

TEST_F(NrrdErrors, RefuseSkipsBeyondTheEnd) {
    const std::string data(24, 'x');
    expect_bad(write("a.nrrd", good + "line skip: 1000000000\n\n" + data), {"line skip"});
    expect_bad(write("a.nrrd", good + "byte skip: 1\n\n" + data), {"23 bytes"});
    expect_bad(write("a.nrrd", good + "byte skip: 9000000000000000000\n\n" + data), {"a.nrrd"});
    expect_bad(write("a.nrrd", good + "byte skip: -9223372036854775808\n\n" + data),
               {"a.nrrd", "byte skip"});
    const std::string packed = with("encoding", "encoding: gzip\n");
    expect_bad(write("a.nrrd", packed + "byte skip: -1\n\n" + gzip(data)), {"byte skip"});
    expect_bad(write("a.nrrd", packed + "byte skip: 9000000000000000000\n\n" + gzip(data)),
               {"a.nrrd"});
}

}  // namespace
}  // namespace lamina
