// SPDX-License-Identifier: Apache-2.0
// Damaged and bad files of each format. Each error is one line that names the file, what was found
// and what was expected. The good files come from the fuzz targets' corpora.
#include <gtest/gtest.h>

#include "corpus_files.h"
#include "nrrd_files.h"
#include "volume_files/volume_file.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

using testing::corpus_file;
using testing::with_number;

class VolumeErrors : public testing::WrittenFiles {
  protected:
    // Expects an error of reading a file of these bytes that has `parts` in it.
    void expect(const std::string& name, const std::string& bytes,
                std::initializer_list<std::string> parts, const VolumeRequest& request = {}) {
        const auto path = write(name, bytes);
        SCOPED_TRACE(name);
        expect_error([&] { read_volume(path, request); }, {name});
        expect_error([&] { read_volume(path, request); }, parts);
    }
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

TEST_F(VolumeErrors, NameMistakesInMetaImage) {
    const std::string local = corpus_file("metaimage/local.mha");
    EXPECT_EQ(read_volume(write("a.mha", local)).grid().size,
              (std::array<std::int64_t, 3>{4, 3, 2}));
    expect("a.mha", local.substr(0, local.size() - 1), {"(48 bytes)", "holds 47 bytes"});
    expect("a.mha", corpus_file("metaimage/huge.mha"), {"1000000 x 1000000 x 1000000", "48 bytes"});
    expect("a.mha", replaced(local, "NDims = 3", "NDims = 1"), {"NDims: found '1'", "from 2 to 4"});
    expect("a.mha", replaced(local, "4 3 2", "4 3"), {"DimSize: found '4 3'", "3 whole numbers"});
    expect("a.mha", replaced(local, "MET_SHORT", "MET_STRING"), {"ElementType", "'MET_STRING'"});
    expect("a.mha", replaced(local, "1 2 3", "1 0 3"), {"ElementSpacing", "above 0"});
    expect("a.mha", replaced(local, "1 0 0 0 1 0 0 0 1", "1 0 0 1 1 0 0 0 1"),
           {"TransformMatrix: axes 0 and 1 meet at 45.0000 degrees", "expected 90"});
    expect("a.mha", replaced(local, "0 0 0 1\nOffset", "0 nan 1\nOffset"), {"TransformMatrix"});
    expect("a.mha", replaced(local, "Offset = 0", "Offset = inf"), {"Offset", "finite"});
    expect("a.mha", replaced(local, "ElementDataFile = LOCAL", "Nothing = LOCAL"), {"a.mha"});
    expect("a.mhd", corpus_file("metaimage/many_files.mhd"), {"at most 100000 files"});
    expect("a.mhd", corpus_file("metaimage/apart.mhd"),
           {"data: ElementDataFile of", "no such file"});
    const std::string packed = corpus_file("metaimage/zlib.mha");
    expect("a.mha", packed.substr(0, packed.size() - 3), {"truncated gzip data"});
    expect("a.mha", "ObjectType = Image\nNDims\n", {"line 2", "'NDims'", "'Key = value'"});
}

TEST_F(VolumeErrors, NameMistakesInNifti) {
    const std::string one = corpus_file("nifti/one.nii");
    EXPECT_EQ(read_volume(write("a.nii", one)).grid().size, (std::array<std::int64_t, 3>{4, 3, 2}));
    expect("a.nii", one.substr(0, one.size() - 1), {"holds 47 bytes"});
    expect("a.nii", one.substr(0, 200), {"truncated NIfTI header: found 200 bytes, expected 348"});
    expect("a.nii", corpus_file("nifti/huge.nii"), {"promises 32767 x 32767 x 32767"});
    expect("a.nii", with_number(one, 40, std::int16_t{1}), {"dim[0]: found 1"});
    expect("a.nii", with_number(one, 44, std::int16_t{-5}), {"dim[2]: found -5"});
    std::string seven = with_number(one, 40, std::int16_t{7});
    for (const std::size_t i : {4, 5, 6}) seven = with_number(seven, 40 + 2 * i, std::int16_t{1});
    expect("a.nii", with_number(seven, 54, std::int16_t{2}),
           {"dim[7]: found 2, expected 1: axes beyond x, y, z, time and vector are not read"});
    EXPECT_EQ(read_volume(write("a.nii", with_number(seven, 54, std::int16_t{1}))).grid().size,
              (std::array<std::int64_t, 3>{4, 3, 2}));
    expect("a.nii", with_number(one, 70, std::int16_t{32}), {"datatype: found 32"});
    expect("a.nii", with_number(one, 108, 12.F), {"vox_offset: found 12, expected at least 348"});
    expect("a.nii", corpus_file("nifti/far_offset.nii"), {"vox_offset"});
    expect("a.nii", with_number(one, 284, 1.F), {"sform", "axes 0 and 1 meet at"});
    expect("a.nii", with_number(one, 296, std::nanf("")), {"a.nii: axis 0", "nan"});
    const std::string packed = corpus_file("nifti/packed.nii.gz");
    expect("a.nii.gz", packed.substr(0, 20), {"truncated gzip data"});
    expect("a.nii.gz", packed.substr(0, packed.size() - 2), {"truncated gzip data"});
    expect("a.nii", "nothing at all", {"no NIfTI header"});
    std::string pair = corpus_file("nifti/pair.hdr");
    pair.resize(348);
    expect("a.hdr", pair, {"a.img: data file of", "no such file"});
    expect_error([&] { read_volume(write("alone.img", pair), {}); },
                 {"alone.hdr: header of", "alone.img: no such file"});
    VolumeRequest request;
    request.time = 2;
    expect("a.nii", corpus_file("nifti/times.nii"),
           {"time: found 2", "from 0 to 1", "the file has 2"}, request);
    request = {};
    request.level = 1;
    expect("a.nii", one, {"level: expected no such key: NIfTI files hold only one"}, request);
}

TEST_F(VolumeErrors, NameFormatsThatAreNotRead) {
    const std::string zeros(600, '\0');
    const auto marked = [&](std::size_t at, const std::string& mark) {
        return zeros.substr(0, at) + mark + zeros;
    };
    expect("a.any", marked(208, "MAP "),
           {"found an MRC or CCP4 map, which is not read: the Python"});
    expect("old.rec", marked(212, std::string("DD\0\0", 4)), {"found an MRC or CCP4 map"});
    expect("a.xml", "<?xml version=\"1.0\"?>\n<SpimData version=\"0.2\"/>",
           {"the description of a BigDataViewer volume", ".h5"});
    expect("a.vol", zeros, {"found samples without a header", "--raw"});
    expect("a.mp4", zeros, {"found a film", "ffmpeg"});
    expect("a.stl", "solid a\n", {"found a surface", "trimesh", ".npy"});
    expect("a", marked(0, "LASF"), {"found a cloud of points"});
    expect("a.fld", "# AVS field file\n", {"found an AVS field", ".vti"});
    expect("a.mha", "ObjectType = Mesh\nNDims = 3\n", {"ObjectType: found 'Mesh'", "Image"});
    expect("a.am", marked(0, "# AmiraMesh BINARY"), {"found an Amira or Avizo file", "NRRD"});
    expect("a.x", marked(0, "ZISRAWFILE"), {"found a Zeiss CZI file", "Bio-Formats"});
    expect("a.LIF", zeros, {"found a Leica file"});
    expect("a", marked(0, "SIMPLE  ="), {"found a FITS file"});
    expect("a.mgz", marked(0, "\x1f\x8b"), {"found a FreeSurfer volume", "mri_convert"});
    expect("a.nrrd.gz", marked(0, "\x1f\x8b"), {"found a gzip file", "unpack it first"});
    expect("a.zip", marked(0, "PK\3\4"), {"found a ZIP archive"});
    expect("a.jp2", marked(0, std::string("\0\0\0\x0cjP  ", 8)), {"found a JPEG 2000 picture"});
    expect("a.hdr", marked(0, "ENVI\n"), {"found an ENVI header", "--raw"});
    expect("a.hdr", marked(0, "!INTERFILE :="), {"found an Interfile header"});
    expect("a.tif", marked(0, "GIF89a"), {"found a GIF picture"});
    expect("a.nrrd", marked(0, "version https://git-lfs.github.com/spec/v1"), {"Git LFS pointer"});
    expect("a.nii", marked(0, "<!DOCTYPE html>"), {"found a web page"});
    expect("a.nrrd", "", {"a.nrrd: the file is empty"});
    expect("a.any", "", {"a.any: the file is empty"});
    expect("a.any", zeros, {"unknown kind of volume"});
}

TEST_F(VolumeErrors, NameMistakesInNumpy) {
    const std::string good_one = corpus_file("npy_volume/i2.npy");
    EXPECT_EQ(read_volume(write("a.npy", good_one)).grid().size,
              (std::array<std::int64_t, 3>{4, 3, 2}));
    expect("a.npy", good_one.substr(0, good_one.size() - 1), {"holds 47 bytes"});
    expect("a.npy", good_one.substr(0, 40), {"ends too early"});
    expect("a.npy", replaced(good_one, "(2, 3, 4)", "(24,)   "),
           {"'shape': found (24,)", "(y, x) of one slice, or (z, y, x)"});
    expect("a.npy", corpus_file("npy_volume/huge.npy"), {"more than any file holds"});
    expect("a.npy", replaced(good_one, "<i2", "<c8"), {"'descr': found '<c8'", "such as '<f4'"});
    expect("a.npy", replaced(good_one, "<i2", "=i2"), {"'descr': found '=i2'"});
}

TEST_F(VolumeErrors, NameMistakesInVtkImageData) {
    const std::string text = corpus_file("vti/int16_ascii_none.vti");
    read_volume(write("a.vti", text));
    expect("a.vti", corpus_file("vti/huge.vti"), {"a.vti"});
    expect("a.vti", replaced(text, "WholeExtent=\"0 5", "WholeExtent=\"5 0"),
           {"WholeExtent: found '5 0 0 4 0 3'"});
    expect("a.vti", replaced(text, "Spacing=\"0.5", "Spacing=\"0"), {"axis 0", "distance of 0"});
    expect("a.vti", replaced(text, "Extent=\"0 5 0 4 0 3\">", "Extent=\"0 4 0 4 0 3\">"),
           {"a.vti"});
    VolumeRequest request;
    request.array = "w";
    expect("a.vti", text, {"array: found \"w\", expected one of \"v\""}, request);
    const std::string pieces = corpus_file("vti/pieces.vti");
    read_volume(write("a.vti", pieces));
    expect("a.vti", replaced(pieces, "Extent=\"2 4", "Extent=\"1 3"), {"have 24 of 30 samples"});
    expect("a.vti", replaced(pieces, "Extent=\"2 4", "Extent=\"2 3"), {"a.vti"});
    expect("a.vti", replaced(pieces, "Extent=\"2 4", "Extent=\"2 9"), {"Piece 2", "WholeExtent"});
}

TEST_F(VolumeErrors, NameMistakesInTiff) {
    const std::string strips = corpus_file("tiff/strips.tif");
    EXPECT_EQ(read_volume(write("a.tif", strips)).grid().size,
              (std::array<std::int64_t, 3>{18, 20, 3}));
    expect("a.tif", strips.substr(0, 300), {"a.tif: page 2: Can not read TIFF directory"});
    expect("a.tif", strips.substr(0, 6), {"page 1"});
    expect("a.tif", replaced(corpus_file("tiff/imagej.tif"), "frames=3", "frames=4"),
           {"found 6 pages, ImageJ's description has", "4 times"});
    std::filesystem::create_directory(folder_ / "stack");
    expect("a.tif", corpus_file("tiff/huge_page.tif"),
           {"a.tif: pages: found 1 of 150994962 x 10 pixels of 513 samples (774604155060 bytes)"});
    write("stack/1.tif", strips);
    write("stack/2.tif", corpus_file("tiff/tiles.tif"));
    EXPECT_EQ(read_volume(folder_ / "stack").grid().size[2], 5);
    write("stack/3.tif", corpus_file("tiff/rgb.tif"));
    expect_error([&] { read_volume(folder_ / "stack"); },
                 {"3.tif: page 1: found 6 x 10 pixels of 3 uint8 samples, expected 18 x 20 of 1"});
    std::filesystem::create_directory(folder_ / "empty");
    expect_error([&] { read_volume(folder_ / "empty"); },
                 {"empty: found a folder with nothing in it, expected a volume: NRRD"});
}

TEST_F(VolumeErrors, NameMistakesInRawFiles) {
    VolumeRequest request;
    request.raw = RawLayout{{2, 2, 2}, "uint16", 1, false};
    expect("a.bin", std::string(16, 'x'),
           {"the layout promises 2 x 2 x 2 uint16 samples (16 bytes)", "holds 15 bytes"}, request);
    request.raw->type = "half";
    expect("a.bin", std::string(17, 'x'), {"type: found \"half\"", "int8, uint8"}, request);
    request.raw = RawLayout{{1, 1, 1}, "uint8", 0, false};
    request.spacing = glm::dvec3(1, 1e200, 1);
    expect("a.bin", "x", {"distance of 1e+200"}, request);
    request = {};
    request.raw = RawLayout{{1, 1, 1}, "uint8", 0, false};
    request.channel = 0;
    expect("a.bin", "x", {"channel: expected no such key"}, request);
}

}  // namespace
}  // namespace lamina
