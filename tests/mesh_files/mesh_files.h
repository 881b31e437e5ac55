// SPDX-License-Identifier: Apache-2.0
// The fixture and helpers of the tests of mesh files.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "mesh_files/mesh_file.h"
#include "support/expect_error.h"
#include "support/mesh_makers.h"
#include "support/temporary_folder.h"
#include "support/test_grid.h"

namespace lamina::testing {

class MeshFiles : public ::testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) {
        write_bytes_to(folder_ / name, bytes);
        return folder_ / name;
    }
    MeshData read(const std::string& name, const std::string& bytes) {
        return read_mesh(write(name, bytes));
    }
    const std::filesystem::path& folder() const { return folder_.path(); }
    // Runs a script of tests/mesh_files, which writes to folder(). Returns its wait status; exit
    // code 77: the libraries that it needs are not installed.
    int run_script(const std::string& name) const {
        return std::system(fmt::format("/usr/bin/python3 '{}/tests/mesh_files/{}' '{}'",
                                       LAMINA_SOURCE_DIR, name, folder().string())
                               .c_str());
    }

  private:
    TemporaryFolder folder_;
};

// Expects scalars of equal names and values, where NaN equals NaN.
inline void expect_equal(const std::vector<MeshScalar>& a, const std::vector<MeshScalar>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].name, b[i].name);
        ASSERT_EQ(a[i].values.size(), b[i].values.size());
        for (std::size_t j = 0; j < a[i].values.size(); ++j) {
            if (std::isnan(a[i].values[j]) && std::isnan(b[i].values[j])) continue;
            ASSERT_EQ(a[i].values[j], b[i].values[j]) << a[i].name << " " << j;
        }
    }
}

inline void expect_equal(const MeshData& a, const MeshData& b) {
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.tets, b.tets);
    expect_equal(a.point_scalars, b.point_scalars);
    expect_equal(a.cell_scalars, b.cell_scalars);
}

inline std::filesystem::path data_folder() {
    if (const char* const folder = std::getenv("LAMINA_DATA")) return folder;
    return std::filesystem::path(LAMINA_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace lamina::testing
