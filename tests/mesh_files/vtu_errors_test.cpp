// SPDX-License-Identifier: Apache-2.0
// Bad .vtu files of every kind. Each error is one line that names the file, what was found and what
// was expected.
#include "bad_mesh_files.h"

namespace lamina {
namespace {

using testing::all_vtu_styles;
using testing::make_vtu;
using testing::mixed_grid;
using testing::TestGrid;
using testing::VtuMaker;
using testing::VtuStyle;
using testing::with;

using VtuErrors = testing::BadMeshFiles;

TEST_F(VtuErrors, NameTheBadAttribute) {
    const std::string good = make_vtu(mixed_grid());
    const std::string points = "NumberOfPoints=\"24\"", cells = "NumberOfCells=\"8\"";
    for (const std::string count : {"-24", "2.4", "", "many", "99999999999999999999"}) {
        expect_bad("a.vtu", with(good, points, "NumberOfPoints=\"" + count + "\""),
                   {"NumberOfPoints", "'" + count + "'", "whole number"});
    }
    expect_bad("a.vtu", with(good, points, ""), {"NumberOfPoints: found none"});
    expect_bad("a.vtu", with(good, points, "NumberOfPoints=\"25\""), {"Points: value 73 of 75"});
    expect_bad("a.vtu", with(good, points, "NumberOfPoints=\"23\""), {"found more"});
    expect_bad("a.vtu", with(good, cells, "NumberOfCells=\"9\""), {"types", "9"});
    expect_bad("a.vtu", with(good, "LittleEndian", "MiddleEndian"), {"byte_order", "Middle"});
    expect_bad("a.vtu", with(good, "byte_order", "header_type=\"Int8\" byte_order"),
               {"header_type", "'Int8'"});
    expect_bad("a.vtu", with(good, "Name=\"types\"", "Name=\"typos\""), {"no array 'types'"});
    expect_bad("a.vtu", with(good, "<Cells>", "<Cello>"), {"XML"});
    expect_bad("a.vtu", with(with(good, "<Cells>", "<Cel>"), "</Cells>", "</Cel>"), {"no <Cells>"});
    expect_bad("a.vtu", with(with(good, "<Points>", "<P>"), "</Points>", "</P>"), {"no <Points>"});
    expect_bad("a.vtu",
               with(good, "Name=\"Points\" NumberOfComponents=\"3\"",
                    "Name=\"Points\" NumberOfComponents=\"2\""),
               {"Points: NumberOfComponents: found 2, expected 3"});
    expect_bad("a.vtu", with(good, "Int64\" Name=\"connectivity", "Float64\" Name=\"connectivity"),
               {"connectivity", "Float64", "integer"});
    expect_bad("a.vtu", with(good, "type=\"Float32\"", "type=\"Float16\""), {"'Float16'"});
    expect_bad("a.vtu", with(good, "format=\"ascii\"", "format=\"morse\""), {"'morse'"});
    expect_bad("a.vtu", with(good, "format=\"ascii\"", "format=\"appended\" offset=\"0\""),
               {"no AppendedData"});
}

TEST_F(VtuErrors, NameTheArrayAndTheBadNumber) {
    const std::string good = make_vtu(mixed_grid());
    expect_bad("a.vtu", with(good, "-1.5 ", "-1.5x "), {"pressure", "'-1.5x'", "Float32"});
    expect_bad("a.vtu", with(good, "-1.5 ", "1e39 "), {"pressure", "'1e39'", "Float32"});
    expect_bad("a.vtu", with(good, "60000 ", "70000 "), {"region", "'70000'", "UInt16"});
    expect_bad("a.vtu", with(good, "60000 ", "1.5 "), {"region", "'1.5'", "UInt16"});
    expect_bad("a.vtu", with(good, "60000 ", ""), {"region", "value 8 of 8"});
    expect_bad("a.vtu", with(good, "60000 ", std::string(100000, '9') + " "), {"999...'"});
}

TEST_F(VtuErrors, NameTheArrayOfBadOffsets) {
    const std::string good = make_vtu(mixed_grid());
    expect_bad("a.vtu", with(good, "4 7 15 21", "4 17 15 21"), {"offsets", "15", "cell 2"});
    expect_bad("a.vtu", with(good, "4 7 15 21", "-4 7 15 21"), {"offsets", "-4", "cell 0"});
    expect_bad("a.vtu", with(good, "36\n40", "36\n41"), {"connectivity", "41"});
    expect_bad("a.vtu", with(good, "36\n40", "36\n39"), {"connectivity", "more", "39"});
    expect_bad("a.vtu", with(good, "36\n40", "36\n-40"), {"offsets", "-40"});
    expect_bad("a.vtu", with(good, "36\n40", "36\n4000000000000000000"), {"connectivity", "4000"});
}

TEST_F(VtuErrors, NameThePieceThatDoesNotMatch) {
    TestGrid other = mixed_grid();
    other.point_arrays[0].name = "density";
    expect_bad("a.vtu", VtuMaker(VtuStyle()).file({mixed_grid(), other}),
               {"Piece 2", "no array 'pressure'"});
    other.point_arrays.clear();
    expect_bad("a.vtu", VtuMaker(VtuStyle()).file({mixed_grid(), other}),
               {"Piece 2", "0 scalars", "expected 6"});
    // An index beyond the points of its own piece is out of range, even if the next piece has such
    // a point.
    other = mixed_grid();
    other.cells[0].corners[0] = 30;
    expect_bad("a.vtu", VtuMaker(VtuStyle()).file({other, mixed_grid()}),
               {"Piece 1", "index 30", "0 to 23"});
}

TEST_F(VtuErrors, NameFlawsOfAppendedData) {
    const std::string good = make_vtu(mixed_grid(), {"raw"});
    expect_bad("a.vtu", with(good, "offset=\"0\"", "offset=\"999999\""), {"offset", "999999"});
    expect_bad("a.vtu", with(good, "offset=\"0\"", "offset=\"-1\""), {"offset", "'-1'"});
    expect_bad("a.vtu", with(good, "offset=\"0\"", ""), {"offset: found none"});
    expect_bad("a.vtu", with(good, "encoding=\"raw\"", "encoding=\"hex\""), {"encoding", "'hex'"});
    expect_bad("a.vtu", with(good, "\n  _", "\n   "), {"underscore"});
    expect_bad("a.vtu", with(good, "</AppendedData>", ""), {"truncated"});
    expect_bad("a.vtu", with(good, "offset=\"0\"", "offset=\"4\""), {"pressure", "expected 96"});
    expect_bad("a.vtu", with(make_vtu(mixed_grid(), {"base64"}), "\n  _", "\n  _!"),
               {"Points", "expected base64"});
}

// Arrays must not share their bytes: a small file could fill any memory with them.
TEST_F(VtuErrors, RefuseArraysThatShareTheirBytes) {
    for (const VtuStyle& style : {VtuStyle{"raw"}, VtuStyle{"raw", true}, VtuStyle{"base64"}}) {
        const std::string good = make_vtu(mixed_grid(), style);
        const auto begin = good.find("<DataArray"), end = good.find("/>", begin) + 2;
        std::string bad = good;
        // Adds many copies of an array: a few could use the bytes of arrays that are not read.
        for (int i = 0; i < 50; ++i) bad.insert(end, good.substr(begin, end - begin));
        expect_bad("a.vtu", bad, {"offset", "bytes of appended data, the file has"});
    }
}

TEST_F(VtuErrors, RefuseArraysFarLargerThanTheFile) {
    for (const VtuStyle& style : all_vtu_styles()) {
        const std::string good = make_vtu(mixed_grid(), style);
        expect_bad("a.vtu", with(good, "NumberOfPoints=\"24\"", "NumberOfPoints=\"1000000\""),
                   {"promise", "values", "more than 256 times the file's"});
    }
}

TEST_F(VtuErrors, NameUnknownCompressorsAndDamagedBlocks) {
    const std::string zlib = make_vtu(mixed_grid(), {"raw", true});
    expect_bad("a.vtu", with(zlib, "vtkZLibDataCompressor", "zip"),
               {"'zip'", "vtkZLibDataCompressor", "vtkLZ4DataCompressor", "vtkLZMADataCompressor"});
    for (const std::string name : {"LZ4", "LZMA"}) {
        expect_bad("a.vtu", with(zlib, "vtkZLibDataCompressor", "vtk" + name + "DataCompressor"),
                   {"damaged " + name + " data in block 1 of"});
    }
    // The compressor does not matter in a file whose arrays are all text.
    read("a.vtu", with(make_vtu(mixed_grid()), "byte_order", "compressor=\"zip\" byte_order"));
}

std::string words(std::initializer_list<std::uint32_t> values) {
    std::vector<double> doubles(values.begin(), values.end());
    return testing::bytes_of_array("UInt32", doubles, false);
}

// Returns a block of LZ4 that copies 15 to 269 bytes as they are: a token (its upper half 15: more
// bytes of length follow), one byte of length, the bytes (LZ4 Block Format Description).
std::string lz4_of(const std::string& bytes) {
    return std::string{static_cast<char>(0xf0), static_cast<char>(bytes.size() - 15)} + bytes;
}

// Returns mixed_grid() as text, but its pressure (24 floats) as two blocks of LZ4 that decode to
// `first` and `second`, under a header that promises 56 and 40 bytes.
std::string with_lz4_pressure(const std::string& first, const std::string& second) {
    const std::string one = lz4_of(first), other = lz4_of(second);
    const std::string header = words({2, 56, 40, static_cast<std::uint32_t>(one.size()),
                                      static_cast<std::uint32_t>(other.size())});
    std::string file = with(make_vtu(mixed_grid()), "byte_order",
                            "compressor=\"vtkLZ4DataCompressor\" byte_order");
    file = with(file, "Name=\"pressure\" format=\"ascii\"", "Name=\"pressure\" format=\"binary\"");
    const auto begin = file.find('>', file.find("Name=\"pressure\"")) + 1;
    const auto end = file.find("</DataArray>", begin);
    return file.replace(begin, end - begin, testing::base64(header) + testing::base64(one + other));
}

TEST_F(VtuErrors, NameLz4BlocksOfAnotherLength) {
    const std::vector<double> values = mixed_grid().point_arrays[0].values;
    const std::string bytes = testing::bytes_of_array("Float32", values, false);
    const std::string first = bytes.substr(0, 56), second = bytes.substr(56);
    EXPECT_EQ(read("a.vtu", with_lz4_pressure(first, second)).point_scalars[0].values, values);
    expect_bad("a.vtu", with_lz4_pressure(first.substr(4), second),
               {"pressure", "damaged LZ4 data in block 1 of 2"});
    expect_bad("a.vtu", with_lz4_pressure(first, second.substr(1)),
               {"pressure", "damaged LZ4 data in block 2 of 2"});
    expect_bad("a.vtu", with_lz4_pressure(first, second + "1234"),
               {"pressure", "damaged LZ4 data in block 2 of 2"});
}

TEST_F(VtuErrors, NameTheArrayOfABadZlibHeader) {
    const TestGrid grid = mixed_grid();
    const std::string good = make_vtu(grid, {"raw", true});
    const auto data = good.find('_', good.find("<AppendedData")) + 1;
    const auto put = [&](std::size_t word, std::uint32_t value) {
        std::string bad = good;
        return bad.replace(data + 4 * word, 4, words({value}));
    };
    // 24 floats: 96 bytes in blocks of 56 and 40.
    expect_bad("a.vtu", put(0, 0xffffffff), {"pressure", "4294967295 compressed blocks"});
    expect_bad("a.vtu", put(1, 0xffffffff), {"pressure", "more than zlib can hold"});
    expect_bad("a.vtu", put(2, 41), {"pressure", "found 97", "expected 96"});
    expect_bad("a.vtu", put(3, 0xfffffff0), {"pressure", "end of the file"});
    expect_bad("a.vtu", put(5, 0x12345678), {"pressure", "damaged zlib data in block 1"});
    expect_bad("a.vtu", put(0, 0), {"pressure", "found 0", "expected 96"});
}

TEST_F(VtuErrors, AreGivenForXmlOfAnyDepthAndLength) {
    const std::string head = "<VTKFile type=\"UnstructuredGrid\">";
    std::string deep;
    for (int i = 0; i < 300000; ++i) deep += "<a>";
    expect_bad("a.vtu", head + deep, {"XML"});
    for (int i = 0; i < 300000; ++i) deep += "</a>";
    expect_bad("a.vtu", head + deep + "</VTKFile>", {"<UnstructuredGrid>"});
    std::string many;
    for (int i = 0; i < 1100000; ++i) many += "<a/>";
    expect_bad("a.vtu", head + many + "</VTKFile>", {"tags", "at most 1000000"});
    expect_bad("a.vtu", head + "<!DOCTYPE a [<!ENTITY b \"&b;&b;\">]>&b;</VTKFile>", {"a.vtu"});
}

}  // namespace
}  // namespace lamina
