// SPDX-License-Identifier: Apache-2.0
// Labels in files: taken for what they are, numbered if 16 bits do not hold them, and said.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "corpus_files.h"
#include "expect_boxes.h"
#include "nrrd_files.h"
#include "support/heard_warnings.h"
#include "volume/labels.h"
#include "volume/nrrd_writer.h"
#include "volume_files/bricked_copy.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using testing::bytes_of_values;
using testing::samples_of;

VolumeRequest as_linear() {
    VolumeRequest request;
    request.lookup = VolumeLookup::linear;
    return request;
}

class LabelFiles : public testing::WrittenFiles {
  protected:
    // Writes a row of samples as a raw NRRD file, each of them `times` times.
    template <typename T>
    std::filesystem::path row(const char* type, const std::vector<T>& values, int times = 40) {
        std::vector<T> samples;
        for (const T value : values)
            for (int i = 0; i < times; ++i) samples.push_back(value);
        return write("row.nrrd", fmt::format("NRRD0004\ntype: {}\ndimension: 3\nencoding: raw\n"
                                             "endian: little\nsizes: {} 1 1\n\n",
                                             type, samples.size()) +
                                     bytes_of_values(samples));
    }

    static void save(const Volume& volume, const std::filesystem::path& path) {
        AtomicFile file(path);
        write_nrrd(file, volume);
        file.commit();
    }

    static std::vector<std::string> numbers_of(const Volume& volume) {
        std::vector<std::string> numbers;
        for (const Label& label : volume.labels()->list) numbers.push_back(label.number);
        return numbers;
    }

    test::HeardWarnings heard_;
};

using Numbers = std::vector<std::string>;

TEST_F(LabelFiles, AreTakenForLabelsByMeasure) {
    const auto path = row<std::int32_t>("int32", {0, 3, 17});
    const Volume volume = read_volume(path);
    EXPECT_EQ(volume.grid().lookup, VolumeLookup::nearest);
    EXPECT_EQ(volume.type(), SampleType::uint8);  // which holds the numbers as they are
    EXPECT_EQ(samples_of<std::uint8_t>(volume)[119], 17);
    EXPECT_FALSE(volume.labels());
    heard_.expect_said(
        "row.nrrd: its samples are taken for labels, as 96.7 % of them equal their six");
    EXPECT_EQ(read_volume(path, as_linear()).grid().lookup, VolumeLookup::linear);
    EXPECT_TRUE(heard_.texts.empty());
    VolumeRequest nearest;
    nearest.lookup = VolumeLookup::nearest;
    EXPECT_EQ(read_volume(row<std::uint8_t>("uint8", {1, 2}, 1), nearest).grid().lookup,
              VolumeLookup::nearest);
    EXPECT_TRUE(heard_.texts.empty());
}

TEST_F(LabelFiles, AreNumberedIfSixteenBitsDoNotHoldThem) {
    const auto path = row<std::int64_t>("int64", {0, 3, 17, 1000000007, -5}, 60);
    const Volume volume = read_volume(path);
    EXPECT_EQ(volume.type(), SampleType::uint8);
    ASSERT_TRUE(volume.labels());
    EXPECT_TRUE(volume.labels()->renumbered);
    EXPECT_EQ(numbers_of(volume), (Numbers{"-5", "0", "3", "17", "1000000007"}));
    const auto codes = samples_of<std::uint8_t>(volume);
    const int expected[] = {1, 2, 3, 4, 0};
    for (std::size_t i = 0; i < codes.size(); ++i) EXPECT_EQ(codes[i], expected[i / 60]) << i;
    heard_.expect_said(
        "its 5 labels, from -5 to 1000000007, are numbered 0 to 4 in increasing order");
    const Volume linear = read_volume(path, as_linear());
    EXPECT_EQ(linear.type(), SampleType::float32);
    EXPECT_FALSE(linear.labels());
}

// A double holds none of these numbers.
TEST_F(LabelFiles, OfSixtyFourBitsStayApart) {
    const std::uint64_t large = (std::uint64_t{1} << 63) + 1;
    const Volume volume = read_volume(row<std::uint64_t>("uint64", {large + 1, large, 0}));
    EXPECT_EQ(numbers_of(volume), (Numbers{"0", "9223372036854775809", "9223372036854775810"}));
}

TEST_F(LabelFiles, OfFloatsAreWholeNumbers) {
    EXPECT_EQ(read_volume(row<double>("double", {0, 1, 200})).type(), SampleType::uint8);
    const Volume far = read_volume(row<float>("float", {0, 1, 3e6F}));
    EXPECT_EQ(numbers_of(far), (Numbers{"0", "1", "3000000"}));
    heard_.texts.clear();
    const Volume halves = read_volume(row<float>("float", {0, .5, 200}));
    EXPECT_EQ(halves.type(), SampleType::float32);
    EXPECT_EQ(halves.grid().lookup, VolumeLookup::linear);
    EXPECT_TRUE(heard_.texts.empty());
}

TEST_F(LabelFiles, BeyondTheMostAreDrawnAsNumbers) {
    std::vector<std::int32_t> values(65536);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 2 * static_cast<std::int32_t>(i);
    VolumeRequest nearest;
    nearest.lookup = VolumeLookup::nearest;
    EXPECT_EQ(read_volume(row("int32", values, 1), nearest).type(), SampleType::float32);
    heard_.expect_said(
        "row.nrrd: more than 65535 labels, which are drawn as numbers of type float");
    values.pop_back();
    EXPECT_EQ(read_volume(row("int32", values, 1), nearest).type(), SampleType::uint16);
    heard_.expect_said("its 65535 labels");
}

TEST_F(LabelFiles, OfNiftiAreKnownByTheirIntent) {
    const auto path =
        write("a.nii", testing::with_number(corpus_file("nifti/one.nii"), 68, std::int16_t{1002}));
    EXPECT_EQ(read_volume(path).grid().lookup, VolumeLookup::nearest);
    heard_.expect_said(
        "a.nii: its samples are labels, as intent_code 1002 says; \"lookup\": \"linear\"");
    EXPECT_EQ(read_volume(path, as_linear()).grid().lookup, VolumeLookup::linear);
    EXPECT_TRUE(heard_.texts.empty());
}

TEST_F(LabelFiles, OfSlicerHaveNamesAndColours) {
    const std::string head = "NRRD0005\ntype: uint8\nencoding: raw\n";
    const std::string segments =
        "Segment0_ID:=s_1\nSegment0_LabelValue:=1\nSegment0_Name:=liver\nSegment0_Layer:=0\n"
        "Segment0_Color:=1 0 .5\nSegment1_ID:=s_2\nSegment1_LabelValue:=4\n"
        "Segment1_Name:=left kidney\nSegment1_Layer:=1\n\n";
    const auto flat = write("a.seg.nrrd", head + "dimension: 3\nsizes: 2 1 1\n" + segments + "12");
    const Volume volume = read_volume(flat);
    EXPECT_EQ(volume.grid().lookup, VolumeLookup::nearest);
    ASSERT_EQ(heard_.texts.size(), 1u) << heard_.all();
    heard_.expect_said(
        "a.seg.nrrd: its samples are labels, as the list of segments (1 is \"liver\", 4 is \"left "
        "kidney\" (channel 1)) says; \"lookup\": \"linear\"");
    ASSERT_EQ(volume.labels()->list.size(), 1u);
    const Label& liver = volume.labels()->list[0];
    EXPECT_EQ(liver.name, "liver");
    EXPECT_EQ(liver.color->r, 1);
    EXPECT_EQ(liver.color->g, 0);
    EXPECT_NEAR(liver.color->b, .2140, 1e-4);  // sRGB .5 (IEC 61966-2-1)
    VolumeRequest layer;
    layer.channel = 1;
    const auto layers = write(
        "b.seg.nrrd", head + "dimension: 4\nsizes: 2 2 1 1\nkinds: list domain domain domain\n" +
                          segments + "1234");
    const Volume second = read_volume(layers, layer);
    ASSERT_EQ(second.labels()->list.size(), 1u);
    EXPECT_EQ(second.labels()->list[0].name, "left kidney");
}

TEST_F(LabelFiles, OfOmeZarrAreKnownByTheirImage) {
    const nlohmann::json zarray{
        {"zarr_format", 2}, {"shape", {1, 1, 3}}, {"chunks", {1, 1, 3}},   {"dtype", "|u1"},
        {"order", "C"},     {"fill_value", 0},    {"compressor", nullptr}, {"filters", nullptr}};
    const nlohmann::json axes{{{"name", "z"}, {"type", "space"}},
                              {{"name", "y"}, {"type", "space"}},
                              {{"name", "x"}, {"type", "space"}}};
    nlohmann::json attributes;
    const nlohmann::json levels = nlohmann::json::array({{{"path", "0"}}});
    attributes["multiscales"] = nlohmann::json::array({{{"axes", axes}, {"datasets", levels}}});
    attributes["image-label"]["colors"] = {{{"label-value", 2}, {"rgba", {255, 0, 0, 0}}},
                                           {{"label-value", 1}, {"rgba", "red"}}};
    attributes["image-label"]["properties"] = {{{"label-value", 1}, {"area (pixels)", 1200}},
                                               {{"label-value", 2}, {"class", "nucleus"}}};
    const auto image = folder() / "cells";
    std::filesystem::create_directories(image / "0");
    write_bytes_to(image / ".zgroup", R"({"zarr_format": 2})");
    write_bytes_to(image / ".zattrs", attributes.dump());
    write_bytes_to(image / "0" / ".zarray", zarray.dump());
    write_bytes_to(image / "0" / "0.0.0", std::string("\0\2\1", 3));
    for (const auto& path : {image, image / "0"}) {
        const Volume volume = read_volume(path);
        EXPECT_EQ(volume.grid().lookup, VolumeLookup::nearest);
        heard_.expect_said("its samples are labels, as the OME-Zarr image says");
        ASSERT_EQ(volume.labels()->list.size(), 2u);
        EXPECT_FALSE(volume.labels()->list[0].color);
        EXPECT_EQ(volume.labels()->list[0].name, "");
        EXPECT_EQ(volume.labels()->list[0].opacity, 1);
        EXPECT_EQ(volume.labels()->list[1].color, glm::dvec3(1, 0, 0));
        EXPECT_EQ(volume.labels()->list[1].opacity, 0);
        EXPECT_EQ(volume.labels()->list[1].name, "nucleus");
    }
}

TEST_F(LabelFiles, ThatLookLikeLabelsButAreTakenForAFieldAreNamed) {
    std::vector<std::int32_t> steps(10);  // by 1, as in a rounded ramp
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = static_cast<std::int32_t>(i);
    EXPECT_EQ(read_volume(row("int32", steps, 60)).grid().lookup, VolumeLookup::linear);
    heard_.expect_said(
        "97 % of them equal their six neighbours, but 100 % of unequal neighbours differ by 1");
    EXPECT_EQ(read_volume(row<std::int32_t>("int32", {0, 90, 4, 70}, 10)).grid().lookup,
              VolumeLookup::linear);
    heard_.expect_said(
        "row.nrrd: its samples look like labels, but only 85 % of them equal their six");
    EXPECT_EQ(read_volume(row<std::int32_t>("int32", {0, 90000, 4, 70000}, 10)).grid().lookup,
              VolumeLookup::linear);
    heard_.expect_said("(--set volume.lookup=nearest) takes them for labels");
    read_volume(row("int32", steps, 60), as_linear());
    EXPECT_TRUE(heard_.texts.empty());
}

// No VTK format says of values that they are labels: samples are measured there, too.
TEST_F(LabelFiles, OfVtkAreMeasured) {
    const auto repeated = [](int times) {
        std::string text;
        for (const char* const value : {"0 ", "90 ", "4 ", "70 "})
            for (int i = 0; i < times; ++i) text += value;
        return text;
    };
    const auto xml = [&](const char* type, const char* of, int times) {
        const bool cells = std::string_view(of) == "CellData";
        const std::string extent = fmt::format("\"0 {} 0 {} 0 {}\"", 4 * times - (cells ? 0 : 1),
                                               cells ? 1 : 0, cells ? 1 : 0);
        return write("row.vti",
                     fmt::format("<VTKFile type=\"ImageData\" version=\"1.0\"><ImageData "
                                 "WholeExtent={0} Spacing=\"1 1 1\" Origin=\"0 0 0\"><Piece "
                                 "Extent={0}><{1} Scalars=\"s\"><DataArray Name=\"s\" "
                                 "type=\"{2}\" format=\"ascii\">{3}</DataArray></{1}></Piece>"
                                 "</ImageData></VTKFile>",
                                 extent, of, type, repeated(times)));
    };
    const auto legacy = [&](const char* type, int times) {
        return write("row.vtk",
                     fmt::format("# vtk DataFile Version 3.0\nrow\nASCII\nDATASET "
                                 "STRUCTURED_POINTS\nDIMENSIONS {0} 1 1\nORIGIN 0 0 0\nSPACING 1 1 "
                                 "1\nPOINT_DATA {0}\nSCALARS s {1} 1\nLOOKUP_TABLE default\n{2}\n",
                                 4 * times, type, repeated(times)));
    };
    const auto expect_hints = [&](const auto& file) {
        read_volume(file(10));
        heard_.expect_said("its samples look like labels, but only 85 % of them equal their six");
        EXPECT_EQ(read_volume(file(40)).grid().lookup, VolumeLookup::nearest);
        heard_.expect_said("its samples are taken for labels, as 96.2 % of them equal their six");
    };
    for (const char* const type : {"UInt8", "Int16", "Int32", "Int64", "Float32", "Float64"}) {
        for (const char* const of : {"PointData", "CellData"})
            expect_hints([&](int times) { return xml(type, of, times); });
    }
    for (const char* const type : {"unsigned_char", "short", "int", "float", "double"})
        expect_hints([&](int times) { return legacy(type, times); });
}

// The file's intent says that samples are labels. Their steps: a power of two, which is exact; that
// of a program which scaled 0 to 7 to 8 bits and rounded; one that is no quantum of whole numbers.
TEST_F(LabelFiles, ThatAreScaledAreWholeNumbersOrSaid) {
    const auto scaled = [&](float slope, float shift) {
        std::string bytes =
            testing::with_number(corpus_file("nifti/one.nii"), 68, std::int16_t{1002});
        bytes = testing::with_number(bytes, 112, slope);
        return write("a.nii", testing::with_number(bytes, 116, shift));
    };
    const Volume stored = read_volume(scaled(1, 0));
    heard_.texts.clear();
    const Volume even = read_volume(scaled(2, 100000));
    EXPECT_EQ(even.grid().lookup, VolumeLookup::nearest);
    ASSERT_TRUE(even.labels());
    EXPECT_TRUE(even.labels()->renumbered);
    stored.visit([&](const auto* values) {
        even.visit([&](const auto* codes) {
            for (std::size_t i = 0; i < static_cast<std::size_t>(stored.grid().sample_count());
                 ++i) {
                EXPECT_EQ(even.labels()->list[static_cast<std::size_t>(codes[i])].number,
                          std::to_string(100000 + 2 * static_cast<std::int64_t>(values[i])));
            }
        });
    });
    heard_.texts.clear();
    const Volume halves = read_volume(scaled(.5, .25));
    EXPECT_EQ(halves.type(), SampleType::float32);
    EXPECT_EQ(halves.grid().lookup, VolumeLookup::nearest);
    heard_.expect_said("but, scaled by 0.5 and shifted by 0.25, no whole numbers");
    EXPECT_EQ(read_volume(scaled(.5, .25), as_linear()).grid().lookup, VolumeLookup::linear);
    EXPECT_TRUE(heard_.texts.empty());
}

TEST_F(LabelFiles, KeepNumbersNamesAndColoursWhenTheyAreSaved) {
    Volume volume = read_volume(row<std::int64_t>("int64", {0, 3, 17, 1000000007, -5}, 60));
    std::vector<Label> named{{0, "17", "liver", glm::dvec3(.25, 0, 1)}, {0, "-5", "outside"}};
    named[1].opacity = .5;
    volume = with_descriptions(volume, named);
    const auto saved = folder() / "saved.nrrd";
    save(volume, saved);
    heard_.texts.clear();
    const Volume again = read_volume(saved);
    heard_.expect_said("saved.nrrd: its samples are labels, as the list of segments");
    EXPECT_EQ(numbers_of(again), numbers_of(volume));
    EXPECT_EQ(samples_of<std::uint8_t>(again), samples_of<std::uint8_t>(volume));
    for (std::size_t i = 0; i < volume.labels()->list.size(); ++i) {
        const Label &one = volume.labels()->list[i], &other = again.labels()->list[i];
        EXPECT_EQ(one.name, other.name);
        EXPECT_EQ(one.opacity, other.opacity);
        ASSERT_EQ(one.color.has_value(), other.color.has_value());
        for (int c = 0; one.color && c < 3; ++c)
            EXPECT_NEAR((*one.color)[c], (*other.color)[c], 1e-12);  // sRGB and back
    }
    // Numbers of 64 bits without a sign, and what only the user calls labels.
    const std::uint64_t large = (std::uint64_t{1} << 63) + 1;
    const Volume wide = read_volume(row<std::uint64_t>("uint64", {large + 1, large, 0}));
    save(wide, saved);
    EXPECT_EQ(numbers_of(read_volume(saved)), numbers_of(wide));
    VolumeRequest nearest;
    nearest.lookup = VolumeLookup::nearest;
    save(read_volume(row<std::uint8_t>("uint8", {1, 2, 3, 4}, 1), nearest), saved);
    heard_.texts.clear();
    EXPECT_EQ(read_volume(saved).grid().lookup, VolumeLookup::nearest);
    heard_.expect_said("saved.nrrd: its samples are labels, as its key lamina_lookup says");
}

TEST_F(LabelFiles, KeepTheirNumbersInBrickedCopies) {
    const auto path = row<std::int64_t>("int64", {0, 3, 17, 1000000007, -5}, 60);
    const Volume whole = read_volume(path);
    write_bricked_copy(path, {});
    const Volume copy = open_volume(path, {}, test::in_files);
    EXPECT_FALSE(copy.in_memory());
    EXPECT_EQ(copy.grid().lookup, VolumeLookup::nearest);
    EXPECT_EQ(numbers_of(copy), numbers_of(whole));
    test::expect_boxes(whole, copy);
}

}  // namespace
}  // namespace lamina
