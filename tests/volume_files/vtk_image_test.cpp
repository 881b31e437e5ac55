// SPDX-License-Identifier: Apache-2.0
// Images of VTK in several files, by time, and with mistakes in them. Files as VTK writes them are
// compared with VTK's own reading in reader_oracles_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "nrrd_files.h"
#include "support/heard_warnings.h"
#include "volume_files/volume_file.h"
#include "volume_files/volume_formats.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;
using Paths = std::vector<Path>;

// A file with one piece of points 0 to `last` along x, whose values are `values`.
std::string row_of_points(const std::string& extent, const std::string& values,
                          const std::string& cells = "") {
    return "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"" + extent +
           "\" Origin=\"5 0 0\" Spacing=\"2 1 1\"><Piece Extent=\"" + extent +
           "\"><PointData><DataArray type=\"Int16\" Name=\"v\" format=\"ascii\">" + values +
           "</DataArray></PointData><CellData>" + cells +
           "</CellData></Piece></ImageData></VTKFile>\n";
}

std::string ghost_array(const std::string& values) {
    return "<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">" + values +
           "</DataArray>";
}

std::string joined_file(const std::string& pieces) {
    return "<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"0 5 0 0 0 0\" GhostLevel=\"1\" "
           "Origin=\"5 0 0\" Spacing=\"2 1 1\"><PPointData><PDataArray type=\"Int16\" "
           "Name=\"v\"/></PPointData>" +
           pieces + "</PImageData></VTKFile>\n";
}

std::string grid_file(const std::string& x) {
    return "<VTKFile type=\"RectilinearGrid\"><RectilinearGrid WholeExtent=\"0 3 0 0 0 0\"><Piece "
           "Extent=\"0 3 0 0 0 0\"><PointData><DataArray type=\"Int16\" Name=\"v\" "
           "format=\"ascii\">1 2 3 4</DataArray></PointData><Coordinates><DataArray "
           "type=\"Float64\" format=\"ascii\">" +
           x +
           "</DataArray><DataArray type=\"Float64\" format=\"ascii\">7</DataArray><DataArray "
           "type=\"Float64\" format=\"ascii\">8</DataArray></Coordinates></Piece>"
           "</RectilinearGrid></VTKFile>\n";
}

class VtkImages : public testing::WrittenFiles {
  protected:
    // Returns the samples of a row; NaN is -1.
    std::vector<double> row_of(const Path& path, const VolumeRequest& request = {}) {
        std::vector<double> row;
        const Volume volume = read_volume(path, request);
        volume.visit([&](const auto* samples) {
            for (std::int64_t i = 0; i < volume.grid().sample_count(); ++i) {
                const auto value = static_cast<double>(samples[i]);
                row.push_back(std::isnan(value) ? -1 : value);
            }
        });
        return row;
    }

    void expect_says(const std::string& part) {
        const bool found = std::ranges::any_of(heard_.texts, [&](const std::string& text) {
            return text.find(part) != std::string::npos;
        });
        EXPECT_TRUE(found) << "nothing says " << part;
    }

    test::HeardWarnings heard_;
};

using Row = std::vector<double>;

TEST_F(VtkImages, ArePutTogetherFromFilesThatOverlapByGhosts) {
    write("left.vti", row_of_points("0 3 0 0 0 0", "0 10 20 30", ghost_array("0 0 1")));
    write("right.vti", row_of_points("2 5 0 0 0 0", "20 30 40 50", ghost_array("0 0 0")));
    const Path path =
        write("a.pvti", joined_file("<Piece Extent=\"0 3 0 0 0 0\" Source=\"left.vti\"/>"
                                    "<Piece Extent=\"2 5 0 0 0 0\" "
                                    "Source=\"right.vti\"/>"));
    EXPECT_EQ(row_of(path), (Row{0, 10, 20, 30, 40, 50}));
    EXPECT_EQ(read_volume(path).grid().origin, glm::dvec3(5, 0, 0));
    EXPECT_EQ(read_volume(path).grid().step[0], glm::dvec3(2, 0, 0));
    EXPECT_TRUE(heard_.texts.empty());
    EXPECT_EQ(files_of_volume(path), (Paths{path, folder_ / "left.vti", folder_ / "right.vti"}));
    // By itself the left file lacks its last cell, between 20 and 30, which is the right one's.
    EXPECT_EQ(row_of(folder_ / "left.vti"), (Row{0, 10, 20, -1}));
    expect_says("left.vti: 1 of 4 samples are hidden by ghost arrays");
}

TEST_F(VtkImages, NameTheFileThatIsMissing) {
    write("left.vti", row_of_points("0 3 0 0 0 0", "0 10 20 30"));
    const Path path =
        write("a.pvti", joined_file("<Piece Extent=\"0 3 0 0 0 0\" Source=\"left.vti\"/>"
                                    "<Piece Extent=\"3 5 0 0 0 0\" "
                                    "Source=\"gone.vti\"/>"));
    expect_error([&] { read_volume(path); }, {"gone.vti: piece of", "a.pvti", "no such file"});
    write("gone.vti", row_of_points("3 4 0 0 0 0", "30 40"));
    expect_error([&] { read_volume(path); }, {"a.pvti: its pieces have 5 of 6 samples"});
    const Path half = write("b.pvti", joined_file("<Piece Extent=\"0 3 0 0 0 0\" "
                                                  "Source=\"left.vti\"/>"));
    expect_error([&] { read_volume(half); }, {"b.pvti: its pieces have 4 of 6 samples"});
    const Path none = write("c.pvti", joined_file("<Piece Extent=\"0 5 0 0 0 0\"/>"));
    expect_error([&] { read_volume(none); }, {"c.pvti: Piece 1: Source: found none"});
}

TEST_F(VtkImages, WithAPieceTwiceAreRefused) {
    write("left.vti", row_of_points("0 3 0 0 0 0", "0 10 20 30"));
    const std::string piece = "<Piece Extent=\"0 3 0 0 0 0\" Source=\"left.vti\"/>";
    const std::string again = "<Piece Extent=\"0 3 0 0 0 0\" Source=\"./left.vti\"/>";
    const Path path = write("a.pvti", joined_file(piece + again));
    expect_error([&] { read_volume(path); },
                 {"a.pvti: Piece 2: found the file", "left.vti twice, expected each once"});
}

TEST_F(VtkImages, HideWhatGhostArraysHide) {
    // A cell of points is not drawn if a corner is NaN. Cells 0 and 1 are hidden: points 0 and 1
    // touch no others.
    const Path two =
        write("a.vti", row_of_points("0 4 0 0 0 0", "1 2 3 4 5", ghost_array("32 8 0 0")));
    EXPECT_EQ(row_of(two), (Row{-1, -1, 3, 4, 5}));
    // A hidden cell between others takes both of its points.
    const Path one =
        write("b.vti", row_of_points("0 4 0 0 0 0", "1 2 3 4 5", ghost_array("0 32 0 0")));
    EXPECT_EQ(row_of(one), (Row{1, -1, -1, 4, 5}));
    expect_says("b.vti: hidden cells in layers one cell thick");
    // Refined from elsewhere or exterior, a cell is drawn.
    const Path no =
        write("c.vti", row_of_points("0 4 0 0 0 0", "1 2 3 4 5", ghost_array("2 4 16 0")));
    EXPECT_EQ(row_of(no), (Row{1, 2, 3, 4, 5}));
    EXPECT_EQ(read_volume(no).type(), SampleType::int16);
    const Path bad = write("d.vti", row_of_points("0 4 0 0 0 0", "1 2 3 4 5", ghost_array("2 4")));
    expect_error([&] { read_volume(bad); }, {"d.vti: 'vtkGhostType'", "expected"});
}

TEST_F(VtkImages, WithUnevenStepsAreRefused) {
    const Path even = write("a.vtr", grid_file("-1 .5 2 3.5"));
    EXPECT_EQ(row_of(even), (Row{1, 2, 3, 4}));
    EXPECT_EQ(read_volume(even).grid().origin, glm::dvec3(-1, 7, 8));
    EXPECT_EQ(read_volume(even).grid().step[0], glm::dvec3(1.5, 0, 0));
    // .1, .2 and .3 of float32.
    const Path rounded = write("b.vtr", grid_file("0 0.10000000149 0.20000000298 0.30000001192"));
    EXPECT_NEAR(read_volume(rounded).grid().step[0].x, .1, 1e-8);
    EXPECT_TRUE(heard_.texts.empty());
    expect_error([&] { read_volume(write("c.vtr", grid_file("0 1 2 3.1"))); },
                 {"c.vtr: x coordinates: found 1", "from even steps of 1.03333", "Resample"});
    expect_error([&] { read_volume(write("d.vtr", grid_file("0 1 nan 3"))); }, {"x coordinates"});
    // Large coordinates have few digits: .0625 is the last one of float32 at 1000000.
    read_volume(write("e.vtr", grid_file("1000000 1000000.5 1000001.0625 1000001.5")));
    expect_says("e.vtr: x coordinates: steps are taken as 0.5 each, which moves samples by up to");
    expect_error(
        [&] { read_volume(write("f.vtr", grid_file("1e6 1000000.5 1000001.25 1000001.5"))); },
        {"f.vtr: x coordinates", "0.25 from even steps"});
    // VTK's text has six digits.
    EXPECT_NEAR(
        read_volume(write("g.vtr", grid_file("0.333333 0.666667 1 1.33333"))).grid().step[0].x,
        1. / 3, 1e-5);
}

TEST_F(VtkImages, ByTimeAreStepsOfAPvd) {
    write("0.vti", row_of_points("0 1 0 0 0 0", "1 2"));
    write("1.vti", row_of_points("0 1 0 0 0 0", "3 4"));
    const std::string begin = "<VTKFile type=\"Collection\"><Collection>";
    const std::string end = "</Collection></VTKFile>";
    const Path path = write("a.pvd", begin +
                                         "<DataSet timestep=\".5\" file=\"1.vti\"/><DataSet "
                                         "timestep=\"0\" file=\"0.vti\"/>" +
                                         end);
    ASSERT_TRUE(is_volume_file(path));
    EXPECT_EQ(row_of(path), (Row{1, 2}));
    expect_says("a.pvd: time 0 of 2 is taken");
    VolumeRequest request;
    request.time = 1;
    EXPECT_EQ(row_of(path, request), (Row{3, 4}));
    request.time = 2;
    expect_error([&] { read_volume(path, request); }, {"a.pvd: time: found 2", "from 0 to 1"});
    EXPECT_EQ(files_of_volume(path), (Paths{path, folder_ / "0.vti", folder_ / "1.vti"}));
    VolumeContents contents;
    VolumeUse use;
    use.contents = &contents;
    open_volume(path, {}, use);
    EXPECT_EQ(contents.times, (std::vector<std::string>{"0", "0.5"}));
    EXPECT_EQ(contents.arrays, (std::vector<std::string>{"v"}));
    EXPECT_FALSE(is_volume_file(write("m.pvd", begin + "<DataSet file=\"a.vtu\"/>" + end)));
    expect_error([&] { read_volume(write("b.pvd", begin + "<DataSet file=\"2.vti\"/>" + end)); },
                 {"2.vti: step 0 of", "b.pvd", "no such file"});
    // A list that names itself is no volume.
    EXPECT_FALSE(is_volume_file(write("c.pvd", begin + "<DataSet file=\"c.pvd\"/>" + end)));
}

const std::string legacy =
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n";

TEST_F(VtkImages, OfLegacyFilesHaveArraysOfSeveralKinds) {
    const Path path = write("a.vtk", legacy +
                                         "ASPECT_RATIO 1 2 3\nORIGIN -1 0 0\nFIELD about 1\nTIME 1 "
                                         "1 double\n2.5\nPOINT_DATA 4\nSCALARS mask bit\n"
                                         "LOOKUP_TABLE default\n0 1 1 0\nVECTORS v float\n1 2 3 4 "
                                         "5 6 7 8 9 10 11 12\nCELL_DATA 1\nFIELD f 1\nc 1 1 "
                                         "int\n70000\n");
    ASSERT_TRUE(is_volume_file(path));
    EXPECT_EQ(row_of(path), (Row{0, 1, 1, 0}));
    expect_says("a.vtk: array \"mask\" of 3 is taken");
    VolumeRequest request;
    request.array = "v";
    request.channel = 1;
    EXPECT_EQ(row_of(path, request), (Row{2, 5, 8, 11}));
    EXPECT_EQ(read_volume(path, request).grid().step[1], glm::dvec3(0, 2, 0));
    request = {};
    request.array = "c";
    EXPECT_EQ(row_of(path, request), (Row{70000}));
    EXPECT_EQ(read_volume(path, request).grid().origin, glm::dvec3(-.5, 1, 0));
    // Bits of a binary file are packed, the first in the highest place: 0110 is 96.
    const std::string binary =
        "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\n"
        "DIMENSIONS 4 1 1\nPOINT_DATA 4\nSCALARS m bit\nLOOKUP_TABLE d\n";
    EXPECT_EQ(row_of(write("b.vtk", binary + "\x60\n")), (Row{0, 1, 1, 0}));
    expect_error([&] { read_volume(write("c.vtk", binary)); }, {"c.vtk", "'m'", "expected 1"});
}

TEST_F(VtkImages, OfLegacyFilesNameTheirMistakes) {
    const std::string scalars = "POINT_DATA 4\nSCALARS s int\nLOOKUP_TABLE default\n";
    const auto expect = [&](const std::string& text, std::initializer_list<std::string> parts) {
        expect_error([&] { read_volume(write("a.vtk", text)); }, {"a.vtk"});
        expect_error([&] { read_volume(write("a.vtk", text)); }, parts);
    };
    expect(legacy + scalars + "1 2 3\n", {"'s'", "expected 4"});
    expect(legacy + "POINT_DATA 3\nSCALARS s int\nLOOKUP_TABLE d\n1 2 3\n",
           {"'s': found 3 values, expected 4, one for each point"});
    expect(legacy + "SPACING 1 x 1\n", {"line 6: SPACING: found 'x', expected a number"});
    expect(legacy + "SPACING 0 1 1\n" + scalars + "1 2 3 4\n", {"axis 0", "distance of 0"});
    expect(legacy + "POINTS 4 float\n", {"line 6: found 'points', expected a keyword"});
    expect(legacy, {"no array of numbers"});
    expect("# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 0 1\n",
           {"DIMENSIONS: expected numbers from 1"});
    expect(
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 2 1 1\n"
        "X_COORDINATES 3 float\n1 2 3\n",
        {"X_COORDINATES: found 3, expected 2"});
}

TEST_F(VtkImages, OfOtherKindsAreRefusedByName) {
    const auto xml = [](const std::string& type) {
        return "<VTKFile type=\"" + type + "\"><" + type + "/></VTKFile>\n";
    };
    for (const auto& [name, text, part] :
         {std::tuple{"a.vts", xml("StructuredGrid"), "StructuredGrid"},
          std::tuple{"a.pvts", xml("PStructuredGrid"), "PStructuredGrid"},
          std::tuple{"a.vtp", xml("PolyData"), "a surface has no samples"},
          std::tuple{"a.vtm", xml("vtkMultiBlockDataSet"), "draw one of the files"},
          std::tuple{
              "a.vtk",
              std::string("# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_GRID\n"),
              "Resample To Image"}}) {
        const Path path = write(name, text);
        EXPECT_TRUE(is_volume_file(path)) << name;
        expect_error([&] { read_volume(path); }, {name, "found a VTK file of type", part});
    }
    EXPECT_FALSE(is_volume_file(write("m.vtu", xml("UnstructuredGrid"))));
    EXPECT_FALSE(is_volume_file(
        write("m.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n")));
}

}  // namespace
}  // namespace lamina
