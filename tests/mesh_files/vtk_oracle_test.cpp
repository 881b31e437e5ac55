// SPDX-License-Identifier: Apache-2.0
// Compares lamina's readers and writers of meshes with VTK's own, if Debian's python3-vtk9 is
// installed.
#include <sys/wait.h>

#include <string>

#include "mesh_files.h"
#include "mesh_files/text_reader.h"

namespace lamina {
namespace {

using testing::expect_equal;
using testing::expected_mesh;
using testing::make_vtu;
using testing::mixed_grid;
using testing::TestArray;
using testing::TestCell;
using testing::TestGrid;

template <typename T>
T next(TextReader& reader) {
    T value{};
    EXPECT_TRUE(reader.read(value)) << next_word(reader);
    return value;
}

// Reads the text in which vtk_oracle.py prints a grid.
TestGrid read_dump(const std::filesystem::path& path) {
    const std::string text = read_bytes_of(path);
    TextReader reader(text);
    TestGrid grid;
    while (!reader.at_end()) {
        const std::string word(reader.word());
        const auto count = next<int>(reader);
        if (word == "points") {
            for (int i = 0; i < count; ++i) {
                const auto x = next<double>(reader), y = next<double>(reader);
                grid.points.emplace_back(x, y, next<double>(reader));
            }
        } else if (word == "cells") {
            for (int i = 0; i < count; ++i) {
                TestCell cell{next<int>(reader), {}};
                const auto corners = next<int>(reader);
                for (int j = 0; j < corners; ++j) cell.corners.push_back(next<int>(reader));
                grid.cells.push_back(cell);
            }
        } else {
            const bool points = word == "point_array";
            reader.skip(1);
            TestArray array{std::string(reader.line()), "Float64", count, {}};
            const std::size_t tuples = points ? grid.points.size() : grid.cells.size();
            for (std::size_t i = 0; i < tuples * static_cast<std::size_t>(count); ++i) {
                array.values.push_back(next<double>(reader));
            }
            (points ? grid.point_arrays : grid.cell_arrays).push_back(array);
        }
        if (::testing::Test::HasFailure()) break;
    }
    return grid;
}

using VtkOracle = testing::MeshFiles;

TEST_F(VtkOracle, AgreesOnReadAndWrittenFiles) {
    const MeshData ours = expected_mesh(mixed_grid());
    AtomicFile file(folder() / "ours.vtu");
    write_vtu(file, ours);
    file.commit();
    const int status = run_script("vtk_oracle.py");
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "python3-vtk9 is not installed";
    ASSERT_EQ(status, 0);

    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) {
        if (!is_mesh_file(entry.path())) continue;
        SCOPED_TRACE(entry.path().filename());
        auto dump = entry.path();
        dump += ".dump";
        const TestGrid grid = read_dump(dump);
        ASSERT_GE(grid.points.size(), 24u);
        MeshData expected = expected_mesh(grid);
        const MeshData mesh = read_mesh(entry.path());
        EXPECT_EQ(mesh.cells.split, expected.cells.split);
        EXPECT_EQ(mesh.cells.skipped, expected.cells.skipped);
        // VTK changes the order of a file's arrays.
        const auto by_name = [](const MeshScalar& a, const MeshScalar& b) {
            return a.name < b.name;
        };
        MeshData sorted = mesh;
        for (MeshData* const one : {&expected, &sorted}) {
            std::ranges::sort(one->point_scalars, by_name);
            std::ranges::sort(one->cell_scalars, by_name);
        }
        expect_equal(sorted, expected);
        if (entry.path().filename() == "ours.vtu") expect_equal(mesh, ours);
        ++files;
    }
    EXPECT_EQ(files, 48 + 4 + 1);
}

}  // namespace
}  // namespace lamina
