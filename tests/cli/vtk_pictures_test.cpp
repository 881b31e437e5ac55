// SPDX-License-Identifier: Apache-2.0
// Opacities and colours mean the same as in VTK: compares pictures, if Debian's python3-vtk9 and
// xvfb are installed.
#include <gtest/gtest.h>

#include <iostream>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// The Python script prints what it compares. The mean must be within 1.5 codes: VTK samples a ray
// every .05 voxels, looks values up in tables of some thousand entries, ends a ray at an opacity of
// .996 (1 code), and, like lamina, rounds to 8 bits.
TEST(VtkPictures, AgreeWithLaminaWithinCodes) {
    const TemporaryFolder folder;
    const ProgramResult result =
        run_program({"/usr/bin/python3", LAMINA_SOURCE_DIR "/tests/cli/vtk_pictures.py",
                     LAMINA_BINARY, folder.path()});
    if (result.exit_code == 77 || result.exit_code == 127) GTEST_SKIP() << result.out;
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    std::cout << result.out;
}

}  // namespace
}  // namespace lamina
