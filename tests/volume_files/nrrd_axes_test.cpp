// SPDX-License-Identifier: Apache-2.0
// NRRD files with several channels or times, in several files, and of every scalar type.
#include <gtest/gtest.h>

#include <cmath>

#include "nrrd_files.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "volume_files/numbered_files.h"

namespace lamina {
namespace {

using testing::bytes_of_values;
using testing::gzip;
using testing::samples_of;
using Samples = std::vector<std::uint8_t>;

class NrrdAxes : public testing::WrittenFiles {
  protected:
    test::HeardWarnings heard_;
    std::vector<std::string>& warnings_ = heard_.texts;
};

std::string counting(int count) {
    std::string bytes;
    for (int i = 0; i < count; ++i) bytes += static_cast<char>(i);
    return bytes;
}

TEST_F(NrrdAxes, OneChannelOfThreeIsTaken) {
    const auto path =
        write("a.nrrd",
              "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 2 1\nkinds: RGB-color domain domain "
              "domain\nencoding: raw\n\n" +
                  counting(12));
    EXPECT_EQ(samples_of<std::uint8_t>(open_nrrd(path)), (Samples{0, 3, 6, 9}));
    ASSERT_EQ(warnings_.size(), 1u);
    expect_says(warnings_[0], {"a.nrrd: channel 0 of 3 is taken"});
    warnings_.clear();
    VolumeRequest request;
    request.channel = 2;
    EXPECT_EQ(samples_of<std::uint8_t>(open_nrrd(path, request)), (Samples{2, 5, 8, 11}));
    EXPECT_TRUE(warnings_.empty());
    request.channel = 3;
    expect_error([&] { open_nrrd(path, request); },
                 {"a.nrrd: channel: found 3, expected a whole number from 0 to 2"});
    request = {};
    request.time = 1;
    expect_error([&] { open_nrrd(path, request); }, {"time: found 1", "from 0 to 0"});
    files_of_nrrd(path);
}

TEST_F(NrrdAxes, WithoutASpacingAreNotInSpaceIfOthersHaveOne) {
    const std::string begin = "NRRD0004\ntype: uint8\ndimension: 4\nencoding: raw\n";
    const Volume volume = open_nrrd(
        write("a.nrrd", begin + "sizes: 3 2 2 1\nspacings: nan .5 1 2\n\n" + counting(12)));
    EXPECT_EQ(samples_of<std::uint8_t>(volume), (Samples{0, 3, 6, 9}));
    EXPECT_EQ(volume.grid().step[0].x, .5);
    ASSERT_EQ(warnings_.size(), 1u);
    expect_says(warnings_[0], {"a.nrrd: channel 0 of 3 is taken"});
    expect_error([&] { open_nrrd(write("b.nrrd", begin + "sizes: 3 2 2 2\n\n" + counting(24))); },
                 {"found 4 axes (sizes 3 2 2 2)", "by kinds, directions and spacings"});
}

TEST_F(NrrdAxes, ChannelAndTimeAreTakenTogetherAndInPackedData) {
    for (const bool packed : {false, true}) {
        const auto path =
            write("a.nrrd",
                  std::string(
                      "NRRD0004\ntype: uint8\ndimension: 5\nsizes: 2 1 2 3 2\nkinds: vector domain "
                      "domain time domain\nencoding: ") +
                      (packed ? "gzip\n\n" + gzip(counting(24)) : "raw\n\n" + counting(24)));
        VolumeRequest request;
        request.channel = 1;
        request.time = 2;
        // Samples at channel 1 and time 2: channel + 2 * (y + 2 * (time + 3 * z)).
        EXPECT_EQ(samples_of<std::uint8_t>(open_nrrd(path, request)), (Samples{9, 11, 21, 23}));
    }
}

// Data larger than the scratch memory of TakenReader are read in pieces.
TEST_F(NrrdAxes, LargeDataAreTakenPieceByPiece) {
    std::vector<std::uint16_t> values(std::size_t{3} * 1200 * 1100 * 2);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint16_t>(i * 7);
    const auto path = write("a.nrrd",
                            "NRRD0004\ntype: ushort\ndimension: 4\nsizes: 3 1200 1100 2\nkinds: "
                            "list domain domain domain\nendian: big\nencoding: raw\n\n" +
                                bytes_of_values(values, true));
    VolumeRequest request;
    request.channel = 1;
    const auto found = samples_of<std::uint16_t>(open_nrrd(path, request));
    ASSERT_EQ(found.size() * 3, values.size());
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], values[3 * i + 1]) << i;
}

TEST_F(NrrdAxes, AreChannelsWithoutDirectionsInSpace) {
    const auto path =
        write("a.nrrd",
              "NRRD0004\ntype: uint8\ndimension: 4\nspace dimension: 3\nsizes: 1 2 2 3\nspace "
              "directions: (1,0,0) (0,1,0) (0,0,1) none\nencoding: raw\n\n" +
                  counting(12));
    EXPECT_EQ(samples_of<std::uint8_t>(open_nrrd(path)), (Samples{0, 1, 2, 3}));
}

TEST_F(NrrdAxes, DataFilesAreListedOrNumbered) {
    const std::string header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 3\nencoding: ";
    for (int z = 0; z < 3; ++z) {
        const std::string slice = counting(12).substr(static_cast<std::size_t>(4 * z), 4);
        write(fmt::format("s{}.raw", 7 + 2 * z), fmt::format("12{}", slice));
        write(fmt::format("p{}.gz", z), gzip(slice));
        std::string text;
        for (const char sample : slice) text += fmt::format("{} ", static_cast<int>(sample));
        write(fmt::format("t{}.txt", z), text);
        write(fmt::format("half{}.raw", z), slice);
    }
    Samples expected(12);
    for (std::size_t i = 0; i < 12; ++i) expected[i] = static_cast<std::uint8_t>(i);
    for (const std::string fields :
         {"raw\nbyte skip: 2\ndata file: s%d.raw 7 11 2\n",
          "raw\nbyte skip: 2\ndata file: s%01d.raw 7 11 2 2\n",
          "raw\nbyte skip: -1\ndata file: LIST\ns7.raw\ns9.raw\ns11.raw\n",
          "gzip\ndata file: LIST 2\np0.gz\np1.gz\np2.gz\n", "ascii\ndata file: t%d.txt 0 2 1\n",
          "raw\ndata file: half%d.raw 0 2 1 3\n"}) {
        SCOPED_TRACE(fields);
        const auto path = write("a.nhdr", header + fields);
        EXPECT_EQ(samples_of<std::uint8_t>(open_nrrd(path)), expected);
        EXPECT_EQ(files_of_nrrd(path).size(), 4u);
    }
    EXPECT_TRUE(warnings_.empty()) << warnings_[0];
    open_nrrd(write("a.nhdr", header + "raw\ndata file: LIST\ns7.raw\nhalf1.raw\nhalf2.raw\n"));
    ASSERT_EQ(warnings_.size(), 1u);
    expect_says(warnings_[0],
                {"a.nhdr: found 2 bytes more in ", "s7.raw than the 2 x 2 x 3 uint8"});
    write("half1.raw", "123");
    expect_error([&] { open_nrrd(folder() / "a.nhdr"); }, {"half1.raw holds 3 bytes", "(4 bytes)"});
}

TEST_F(NrrdAxes, EveryScalarTypeIsRead) {
    const auto read = [&](const std::string& type, const std::string& bytes) {
        return open_nrrd(write("a.nrrd", "NRRD0004\ntype: " + type +
                                             "\ndimension: 3\nsizes: 3 1 1\nendian: "
                                             "big\nencoding: raw\n\n" +
                                             bytes));
    };
    const auto big = [](const auto& values) { return bytes_of_values(values, true); };
    using Shorts = std::vector<std::int16_t>;
    EXPECT_EQ(samples_of<std::int16_t>(read("int8", big(std::vector<std::int8_t>{-3, 0, 7}))),
              (Shorts{-3, 0, 7}));
    EXPECT_EQ(samples_of<std::int16_t>(read("int", big(std::vector<std::int32_t>{-3, 0, 700}))),
              (Shorts{-3, 0, 700}));
    EXPECT_EQ(samples_of<std::uint8_t>(read("uint", big(std::vector<std::uint32_t>{3, 0, 7}))),
              (Samples{3, 0, 7}));
    EXPECT_EQ(samples_of<std::int16_t>(read("longlong", big(std::vector<std::int64_t>{-3, 0, 7}))),
              (Shorts{-3, 0, 7}));
    EXPECT_EQ(samples_of<std::uint8_t>(read("uint64", big(std::vector<std::uint64_t>{3, 0, 7}))),
              (Samples{3, 0, 7}));
    EXPECT_EQ(samples_of<float>(read("double", big(std::vector<double>{-.5, 0, 7}))),
              (std::vector<float>{-.5F, 0, 7}));
    const std::string text = "NRRD0004\ndimension: 3\nsizes: 2 1 1\nencoding: ascii\ntype: ";
    EXPECT_EQ(samples_of<float>(open_nrrd(write("t.nrrd", text + "double\n\n.5 1e30\n"))),
              (std::vector<float>{.5F, 1e30F}));
    EXPECT_EQ(samples_of<std::int16_t>(open_nrrd(write("t.nrrd", text + "int64\n\n-5 1e2\n"))),
              (Shorts{-5, 100}));
    expect_error([&] { open_nrrd(write("t.nrrd", text + "int64\n\n1 9223372036854775808\n")); },
                 {"sample 2 of 2", "'9223372036854775808'"});
}

// World axes are LPS. Samples of a file in another space keep their places in the body.
TEST_F(NrrdAxes, NamedSpacesOfPatientsBecomeLps) {
    struct Space {
        const char* name;
        double right, front;  // signs of x and y relative to LPS
    };
    for (const Space& space :
         {Space{"left-posterior-superior", 1, 1}, Space{"LPS", 1, 1}, Space{"scanner-xyz", 1, 1},
          Space{"right-anterior-superior", -1, -1}, Space{"RAS", -1, -1},
          Space{"left-anterior-superior", 1, -1}, Space{"LAS", 1, -1}}) {
        SCOPED_TRACE(space.name);
        const double x = space.right, y = space.front;
        const auto path =
            write("a.nrrd",
                  fmt::format("NRRD0005\ntype: uint8\ndimension: 3\nspace: {}\nsizes: 2 2 3\n"
                              "space directions: ({},{},0) ({},{},0) (0,0,2)\n"
                              "space origin: ({},{},7)\nencoding: raw\n\n{}",
                              space.name, 3 * x, 4 * y, -4 * x, 3 * y, 5 * x, 6 * y, counting(12)));
        const Grid grid = open_nrrd(path).grid();
        EXPECT_EQ(grid.axes, WorldAxes::left_posterior_superior);
        EXPECT_EQ(grid.origin, glm::dvec3(5, 6, 7));
        EXPECT_EQ(grid.step[0], glm::dvec3(3, 4, 0));
        EXPECT_EQ(grid.step[1], glm::dvec3(-4, 3, 0));
        EXPECT_EQ(grid.step[2], glm::dvec3(0, 0, 2));
        EXPECT_FALSE(std::signbit(grid.step[2].x) || std::signbit(grid.step[2].y));  // no -0
    }
    // Grids in other spaces, which name no directions of the body, stay as they are.
    const Grid other =
        open_nrrd(write("a.nrrd",
                        "NRRD0005\ntype: uint8\ndimension: 3\nspace: 3D-left-handed\nsizes: 2 2 3\n"
                        "space directions: (1,0,0) (0,1,0) (0,0,1)\n"
                        "space origin: (5,6,7)\nencoding: raw\n\n" +
                            counting(12)))
            .grid();
    EXPECT_EQ(other.axes, WorldAxes::unnamed);
    EXPECT_EQ(other.origin, glm::dvec3(5, 6, 7));
    ASSERT_EQ(warnings_.size(), 1u);
    expect_says(warnings_[0], {"a.nrrd: space: 3D-left-handed", "shows a mirror image"});
}

TEST_F(NrrdAxes, FilesOfAFolderAreSortedByTheirNumbers) {
    for (const char* name : {"b2", "b10", "a11", "b02", ".hidden", "b", "b10c", "b9"})
        write(name, "x");
    std::vector<std::string> names;
    for (const auto& file : files_in_folder(folder())) names.push_back(file.filename());
    EXPECT_EQ(names, (std::vector<std::string>{"a11", "b", "b02", "b2", "b9", "b10", "b10c"}));
    EXPECT_TRUE(files_in_folder(folder() / "none").empty());
}

}  // namespace
}  // namespace lamina
