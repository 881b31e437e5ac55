// SPDX-License-Identifier: Apache-2.0
// Opacity and colours mean what they mean in VTK: its pictures beside ours, where Debian's
// python3-vtk9 and xvfb are installed.
#include <gtest/gtest.h>

#include <iostream>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

// The program says what it compares. 1.5 codes are what is asked of the mean: VTK samples a ray
// every .05 voxels, looks values up in tables of some thousand entries, stops a ray at an opacity
// of .996 (1 code), and rounds to 8 bits, as we do.
TEST(VtkPictures, AreOursWithinCodes) {
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
