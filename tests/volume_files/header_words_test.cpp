// SPDX-License-Identifier: Apache-2.0
// Units, scales, times, colours and labels in headers of NIfTI, NRRD and MetaImage are used, told
// or refused.
#include <gtest/gtest.h>

#include <cmath>

#include "corpus_files.h"
#include "nrrd_files.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using testing::corpus_file;
using testing::with_number;

using Words = std::vector<std::string>;

class HeaderWords : public testing::WrittenFiles {
  protected:
    VolumeContents contents_of(const std::filesystem::path& path) {
        VolumeContents contents;
        VolumeUse use;
        use.contents = &contents;
        open_volume(path, {}, use);
        return contents;
    }

    test::HeardWarnings heard_;
};

TEST_F(HeaderWords, OfNiftiNameUnitsAndTimes) {
    const std::string times = corpus_file("nifti/times.nii");
    constexpr std::size_t units = 123, step = 76 + 4 * 4, first = 136;  // nifti1.h
    // NIFTI_UNITS_MM + NIFTI_UNITS_MSEC
    std::string text = with_number(times, units, std::uint8_t{2 + 16});
    text = with_number(with_number(text, step, 2.5F), first, 10.F);
    const auto path = write("a.nii", text);
    EXPECT_EQ(read_volume(path).grid().unit, "mm");
    EXPECT_EQ(contents_of(path).times, (Words{"10 ms", "12.5 ms"}));
    EXPECT_FALSE(contents_of(path).is_colour);
    const auto metres = write("b.nii", with_number(times, units, std::uint8_t{1}));
    EXPECT_EQ(read_volume(metres).grid().unit, "m");
    EXPECT_EQ(contents_of(metres).times, (Words{"", ""}));
    const auto none = write("c.nii", with_number(times, units, std::uint8_t{0}));
    EXPECT_EQ(read_volume(none).grid().unit, "");
}

TEST_F(HeaderWords, OfNiftiScaleOnlyIfTheyAreNumbers) {
    const std::string one = corpus_file("nifti/one.nii");
    const auto scaled = [&](float slope, float shift) {
        return write("a.nii", with_number(with_number(one, 112, slope), 116, shift));
    };
    const auto plain = testing::samples_of<std::int16_t>(read_volume(scaled(1, 0)));
    EXPECT_EQ(testing::samples_of<std::int16_t>(read_volume(scaled(NAN, NAN))), plain);
    EXPECT_EQ(heard_.all().find("scl_"), std::string::npos);
    EXPECT_EQ(testing::samples_of<std::int16_t>(read_volume(scaled(0, 7))), plain);
    heard_.expect_said("scl_inter: found 7, which scl_slope 0");
    expect_error([&] { read_volume(scaled(INFINITY, 0)); },
                 {"a.nii: scl_slope", "found inf and 0"});
    expect_error([&] { read_volume(scaled(2, NAN)); }, {"a.nii: scl_slope", "found 2 and nan"});
}

TEST_F(HeaderWords, OfNiftiNameOtherKindsOfFiles) {
    const std::string one = corpus_file("nifti/one.nii");
    expect_error([&] { read_volume(write("a.nii", with_number(one, 68, std::int16_t{3006}))); },
                 {"a.nii: intent_code: found 3006, a CIFTI file"});
    expect_error([&] { read_volume(write("a.hdr", with_number(one, 344, std::int32_t{0}))); },
                 {"a.hdr: found an ANALYZE 7.5 header", "fslchfiletype"});
    // quatern_b of 2, with a qform and no sform.
    std::string turned = with_number(with_number(one, 252, std::int16_t{1}), 254, std::int16_t{0});
    turned = with_number(turned, 256, 2.F);
    expect_error([&] { read_volume(write("a.nii", turned)); }, {"a.nii: quatern_b", "at most 1"});
}

const std::string nrrd_4d = "NRRD0005\ntype: uint8\ndimension: 4\nencoding: raw\n";

TEST_F(HeaderWords, OfNrrdNameUnitsTimesAndColours) {
    const std::string cube = "NRRD0005\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: 2 1 1\n";
    const std::string directions =
        "space: left-posterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
    const auto unit = [&](const std::string& fields) {
        return read_volume(write("a.nrrd", cube + fields + "\n12")).grid().unit;
    };
    EXPECT_EQ(unit(directions + "space units: \"um\" \"um\" \"um\"\n"), "um");
    EXPECT_EQ(unit("spacings: 1 2 3\nunits: \"mm\" \"mm\" \"mm\"\n"), "mm");
    EXPECT_EQ(unit(directions), "");
    EXPECT_EQ(unit("spacings: 1 2 3\nunits: \"mm\" \"\" \"mm\"\n"), "");
    const auto times = write("t.nrrd", nrrd_4d +
                                           "sizes: 2 1 1 3\nkinds: domain domain domain time\n"
                                           "spacings: 1 1 1 0.5\naxis mins: 0 0 0 2\nunits: \"\" "
                                           "\"\" \"\" \"s\"\n\n123456");
    EXPECT_EQ(contents_of(times).times, (Words{"2 s", "2.5 s", "3 s"}));
    const auto colours = write("c.nrrd", nrrd_4d +
                                             "sizes: 3 2 1 1\nkinds: RGB-color domain domain "
                                             "domain\n\n123456");
    EXPECT_TRUE(contents_of(colours).is_colour);
    EXPECT_EQ(contents_of(colours).channels.size(), 3u);
    const auto vectors = write("v.nrrd", nrrd_4d +
                                             "sizes: 3 2 1 1\nkinds: vector domain domain "
                                             "domain\n\n123456");
    EXPECT_FALSE(contents_of(vectors).is_colour);
}

TEST_F(HeaderWords, OfNrrdBringAllAxesToTheUnitOfTheFirst) {
    const std::string cube = "NRRD0005\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: 2 1 1\n";
    const auto grid = [&](const std::string& fields) {
        return read_volume(write("a.nrrd", cube + fields + "\n12")).grid();
    };
    const std::string units = "units: \"mm\" \"mm\" \"um\"\n";
    const Grid spaced = grid("spacings: 1 2 3000\naxis mins: 4 5 6000\n" + units);
    EXPECT_EQ(spaced.unit, "mm");
    EXPECT_EQ(spaced.step[1], glm::dvec3(0, 2, 0));
    EXPECT_EQ(spaced.step[2], glm::dvec3(0, 0, 3));
    EXPECT_EQ(spaced.origin, glm::dvec3(4, 5, 6));
    // Units are those of the world's axes, not of the data's: the third is along x here.
    const Grid turned = grid(
        "space dimension: 3\nspace directions: (0,0,3000) (0,2,0) (1,0,0)\n"
        "space origin: (4,5,6000)\nspace " +
        units);
    EXPECT_EQ(turned.step[0], glm::dvec3(0, 0, 3));
    EXPECT_EQ(turned.step[2], glm::dvec3(1, 0, 0));
    EXPECT_EQ(turned.origin, glm::dvec3(4, 5, 6));
    grid("spacings: 1 2 3\nunits: \"mm\" \"mm\" \"s\"\n");
    EXPECT_TRUE(heard_.texts.empty());  // an axis of one sample
}

TEST_F(HeaderWords, OfNrrdTakeTheFourthAxisOfSpaceForTime) {
    const std::string header = nrrd_4d + "sizes: 2 1 1 3\nspace: left-posterior-superior-time\n";
    const std::string directions = "space directions: (2,0,0,0) (0,3,0,0) (0,0,4,0) (0,0,0,.5)\n";
    const auto path = write("itk.nrrd", header + directions +
                                            "space origin: (5,6,7,1)\nspace units: \"mm\" \"mm\" "
                                            "\"mm\" \"s\"\n\n123456");
    VolumeRequest request;
    request.time = 2;
    const Volume volume = read_volume(path, request);
    EXPECT_EQ(*static_cast<const unsigned char*>(volume.data()), '5');
    EXPECT_EQ(volume.grid().step[1], glm::dvec3(0, 3, 0));
    EXPECT_EQ(volume.grid().origin, glm::dvec3(5, 6, 7));
    EXPECT_EQ(volume.grid().axes, WorldAxes::left_posterior_superior);
    EXPECT_EQ(volume.grid().unit, "mm");
    EXPECT_EQ(contents_of(path).times, (Words{"1 s", "1.5 s", "2 s"}));
    const std::string moving = "space directions: (2,0,0,1) (0,3,0,0) (0,0,4,0) (0,0,0,.5)\n";
    expect_error([&] { read_volume(write("a.nrrd", header + moving + "\n123456")); },
                 {"a.nrrd: space directions: axis 0 runs through time, too"});
}

TEST_F(HeaderWords, OfNrrdSayWhatSegmentsAre) {
    const std::string cube = "NRRD0005\ntype: uint8\ndimension: 3\nencoding: raw\nsizes: 2 1 1\n";
    const auto path =
        write("a.seg.nrrd", cube +
                                "Segment0_ID:=s_1\nSegment0_LabelValue:=1\nSegment0_Name:=liver\n"
                                "Segment0_Layer:=0\nSegment1_ID:=s_2\nSegment1_LabelValue:=4\n"
                                "Segment1_Name:=left kidney\nSegment1_Layer:=1\n\n12");
    read_volume(path);
    heard_.expect_said(
        "its samples are labels, as the list of segments (1 is \"liver\", 4 is \"left kidney\" "
        "(channel 1)) says");
    files_of_volume(path);
    EXPECT_TRUE(heard_.texts.empty());
    read_volume(write("q.nrrd", cube + "old min: -1\nold max: 1\n\n12"));
    heard_.expect_said("old min, old max: found -1 and 1");
}

TEST_F(HeaderWords, OfTwoAxesAreOfOneSlice) {
    const auto expect_slice = [&](const std::filesystem::path& path, const glm::dvec3& first,
                                  double across) {
        SCOPED_TRACE(path.string());
        const Volume slice = read_volume(path);
        EXPECT_EQ(slice.grid().size, (std::array<std::int64_t, 3>{3, 2, 1}));
        EXPECT_EQ(testing::samples_of<std::uint8_t>(slice),
                  (std::vector<std::uint8_t>{'a', 'b', 'c', 'd', 'e', 'f'}));
        EXPECT_EQ(slice.grid().step[0], first);
        EXPECT_EQ(slice.grid().step[2], glm::dvec3(0, 0, across));
        EXPECT_TRUE(heard_.texts.empty()) << heard_.all();
    };
    const std::string samples = "abcdef";
    const std::string nrrd =
        "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 3 2\nencoding: raw\nendian: little\n";
    expect_slice(write("a.nrrd", nrrd + "\n" + samples), {1, 0, 0}, 1);
    expect_slice(write("b.nrrd", nrrd + "spacings: 3 2\n\n" + samples), {3, 0, 0}, 2);
    // As ITK writes them.
    expect_slice(write("c.nrrd", nrrd +
                                     "space dimension: 2\nspace directions: (2,0) (0,3)\n"
                                     "space origin: (5,7)\n\n" +
                                     samples),
                 {2, 0, 0}, 2);
    EXPECT_EQ(read_volume(folder() / "c.nrrd").grid().origin, glm::dvec3(5, 7, 0));
    expect_slice(write("a.mha",
                       "ObjectType = Image\nNDims = 2\nDimSize = 3 2\n"
                       "TransformMatrix = 1 0 0 1\nOffset = 5 7\nElementSpacing = 2 3\n"
                       "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
                           samples),
                 {2, 0, 0}, 2);
    std::string nifti(352, '\0');
    const std::int16_t dim[] = {2, 3, 2};
    const float pixdim[] = {1, 2, 3}, offset = 352;
    nifti = with_number(nifti, 0, std::int32_t{348});
    for (std::size_t i = 0; i < 3; ++i) {
        nifti = with_number(nifti, 40 + 2 * i, dim[i]);
        nifti = with_number(nifti, 76 + 4 * i, pixdim[i]);
    }
    nifti = with_number(with_number(nifti, 70, std::int16_t{2}), 72, std::int16_t{8});
    nifti = with_number(nifti, 108, offset).replace(344, 3, "n+1");
    expect_slice(write("a.nii", nifti + samples), {2, 0, 0}, 2);
    // nibabel gives the sform a third column of any length.
    nifti = with_number(nifti, 254, std::int16_t{1});
    for (std::size_t row = 0; row < 3; ++row)
        nifti = with_number(nifti, 280 + 20 * row, row == 0 ? -2.F : row == 1 ? -3.F : 1.F);
    expect_slice(write("b.nii", nifti + samples), {2, 0, 0}, 2);
    std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 3), }";
    header += std::string(117 - header.size(), ' ') + "\n";
    expect_slice(write("a.npy", std::string("\x93NUMPY\x01\0\x76\0", 10) + header + samples),
                 {1, 0, 0}, 1);
}

TEST_F(HeaderWords, OfMetaImageAreUsedOrNamed) {
    const std::string header = "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\n";
    const std::string data = "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n\x01\x02";
    const auto file = [&](const std::string& fields) {
        return write("a.mha", header + fields + data);
    };
    EXPECT_EQ(read_volume(file("DistanceUnits = um\n")).grid().unit, "um");
    EXPECT_EQ(read_volume(file("DistanceUnits = ?\n")).grid().unit, "");
    // intensity = slope * element + offset (MetaIO, metaImage.h)
    const Volume scaled = read_volume(
        file("ElementToIntensityFunctionSlope = 10\nElementToIntensityFunctionOffset = -3\n"));
    EXPECT_EQ(testing::samples_of<std::uint8_t>(scaled), (std::vector<std::uint8_t>{7, 17}));
    EXPECT_TRUE(heard_.texts.empty());
    read_volume(file("CenterOfRotation = 1 2 3\n"));
    heard_.expect_said("CenterOfRotation: found 1 2 3, which is not used");
    expect_error([&] { read_volume(file("ElementToIntensityFunctionSlope = 0\n")); },
                 {"ElementToIntensityFunctionSlope: found '0', expected a number but 0"});
    expect_error([&] { read_volume(file("HeaderSizePerSlice = 12\n")); },
                 {"HeaderSizePerSlice: found '12'"});
    expect_error(
        [&] {
            read_volume(write("a.mha", "ObjectType = Tube\nNDims = 3\nDimSize = 2 1 1\n" + data));
        },
        {"ObjectType: found 'Tube', expected Image"});
    const auto colours =
        write("c.mha", header + "ElementNumberOfChannels = 3\n" + data + "\x03\x04\x05\x06");
    EXPECT_TRUE(contents_of(colours).is_colour);
    // MetaIO writes the axes of one file as "2D".
    write("1.raw", "1");
    write("2.raw", "2");
    const auto list = write("l.mhd",
                            "NDims = 3\nDimSize = 1 1 2\nElementType = MET_UCHAR\n"
                            "ElementDataFile = LIST 2D\n1.raw\n2.raw\n");
    EXPECT_EQ(testing::samples_of<std::uint8_t>(read_volume(list)),
              (std::vector<std::uint8_t>{'1', '2'}));
}

// A small compressed file can promise, and hold, any number of times.
TEST_F(HeaderWords, ListUpTo65536Times) {
    for (const std::size_t count : {65536u, 65537u}) {
        const std::string samples(count, '1'), size = "1 1 1 " + std::to_string(count);
        const auto nrrd = write("t.nrrd", nrrd_4d + "sizes: " + size +
                                              "\nkinds: domain domain domain time\n\n" + samples);
        const auto meta = write("t.mha", "ObjectType = Image\nNDims = 4\nDimSize = " + size +
                                             "\nElementType = MET_UCHAR\n"
                                             "ElementDataFile = LOCAL\n" +
                                             samples);
        const std::size_t listed = count == 65536 ? count : 0;
        EXPECT_EQ(contents_of(nrrd).times.size(), listed);
        EXPECT_EQ(contents_of(meta).times.size(), listed);
    }
}

}  // namespace
}  // namespace lamina
