// SPDX-License-Identifier: Apache-2.0
// A .vtu with more bytes than its arrays need is read, and a warning counts what is not used.
#include "bad_mesh_files.h"
#include "support/heard_warnings.h"

namespace lamina {
namespace {

using testing::all_vtu_styles;
using testing::make_vtu;
using testing::mixed_grid;
using testing::VtuStyle;
using testing::with;

class VtuSurplus : public testing::MeshFiles {
  protected:
    // Returns the warnings of reading a file, and checks that it holds mixed_grid().
    std::vector<std::string> warnings_of(const std::string& bytes) {
        warnings_.clear();
        const MeshData mesh = read("a.vtu", bytes);
        EXPECT_EQ(mesh.points.size(), mixed_grid().points.size());
        return warnings_;
    }

  private:
    test::HeardWarnings heard_;
    std::vector<std::string>& warnings_ = heard_.texts;
};

TEST_F(VtuSurplus, FilesWithoutItAreReadSilently) {
    for (const VtuStyle& style : all_vtu_styles())
        EXPECT_TRUE(warnings_of(make_vtu(mixed_grid(), style) + "\n \n").empty()) << style.name();
}

TEST_F(VtuSurplus, IsWarnedOfBehindTheFile) {
    for (const VtuStyle& style : all_vtu_styles()) {
        const auto warnings = warnings_of(make_vtu(mixed_grid(), style) + "junk \n!");
        ASSERT_EQ(warnings.size(), 1u) << style.name();
        EXPECT_TRUE(warnings[0].ends_with(
            "a.vtu: found 5 bytes behind </VTKFile>, expected none: they are not used"))
            << warnings[0];
    }
}

TEST_F(VtuSurplus, IsWarnedOfBehindABase64Array) {
    for (const bool compressed : {false, true}) {
        const auto warnings = warnings_of(with(make_vtu(mixed_grid(), {"binary", compressed}),
                                               "\n</DataArray>", " AAAA\n</DataArray>"));
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_NE(warnings[0].find(": found 4 bytes behind its base64 data, expected none"),
                  std::string::npos)
            << warnings[0];
    }
}

TEST_F(VtuSurplus, IsWarnedOfInCompressedBlocks) {
    const auto warnings = warnings_of(make_vtu(mixed_grid(), {"raw", true, false, false, "123"}));
    ASSERT_FALSE(warnings.empty());
    for (const std::string& warning : warnings) {
        EXPECT_NE(warning.find(" bytes behind the zlib data of its "), std::string::npos)
            << warning;
    }
}

}  // namespace
}  // namespace lamina
