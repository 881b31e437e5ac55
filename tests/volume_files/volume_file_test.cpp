// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_file.h"

#include <gtest/gtest.h>

#include <vector>

#include "nrrd_files.h"
#include "support/expect_error.h"

namespace lamina {
namespace {

using VolumeFiles = testing::WrittenFiles;
using Paths = std::vector<std::filesystem::path>;

const std::string small_header =
    "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 1 1\nencoding: raw\n";
const std::vector<std::uint8_t> two_samples = {7, 9};

TEST_F(VolumeFiles, AreRecognizedAsNrrdWhateverTheirName) {
    for (const char* name : {"a.nrrd", "a.NRRD", "a.nhdr", "a.dat", "a"}) {
        const Volume volume = read_volume(write(name, small_header + "\n\x07\x09"));
        EXPECT_EQ(testing::samples_of<std::uint8_t>(volume), two_samples) << name;
    }
}

TEST_F(VolumeFiles, AreKnownByTheirExtensions) {
    for (const char* name : {"a.nrrd", "b/a.NHDR", "a.b.Nrrd"})
        EXPECT_TRUE(is_volume_file(name)) << name;
    for (const char* name : {"a.vtu", "a", "nrrd", ".nrrd", "a.nrrd.gz"})
        EXPECT_FALSE(is_volume_file(name)) << name;
}

TEST_F(VolumeFiles, AreRefusedIfTheirFormatIsUnknown) {
    const std::string nothing = "P5 1 1 255\n";
    expect_error([&] { read_volume(write("a.nrrd", nothing)); }, {"a.nrrd: not a NRRD file"});
    expect_error([&] { read_volume(write("a.any", nothing)); },
                 {"a.any: unknown kind of volume: expected NRRD (.nrrd, .nhdr)"});
    expect_error([&] { read_volume(folder() / "none.raw"); }, {"none.raw", "no such file"});
}

TEST_F(VolumeFiles, AreRefusedByTheKindOfAllFilesInAFolder) {
    std::filesystem::create_directories(folder() / "f");
    write("f/a1.bmp", "BM1");
    write("f/a2.bmp", "BM2");
    expect_error([&] { read_volume(folder() / "f"); },
                 {"f/a1.bmp: found a picture, which is not read", "PNG or TIFF"});
    write("f/notes.any", "text");
    expect_error([&] { read_volume(folder() / "f"); }, {"f: found a folder with unknown kinds"});
}

TEST_F(VolumeFiles, AreNamedIfAFolderOfThemIsGiven) {
    const std::string nrrd = small_header + "\n\x07\x09";
    for (const char* name : {"a.nrrd", "b.nrrd", "c.nrrd", "d.nrrd", "notes.txt"})
        write(name, nrrd);
    write("notes.txt", "text");
    write("mesh.node", "text");
    write(".hidden.nrrd", nrrd);
    std::filesystem::create_directories(folder() / "deep" / "deeper");
    write("deep/e.nrrd", nrrd);
    write("deep/letter.txt", "text");
    write("deep/deeper/f.nrrd", nrrd);
    std::filesystem::create_directories(folder() / "z.zarr");
    expect_error([&] { read_volume(folder()); },
                 {": found a folder with unknown kinds (notes.txt), NRRD (a.nrrd, b.nrrd, c.nrrd, "
                  "...), Zarr (z.zarr/), meshes (mesh.node), expected the name of one of these"});
    expect_error([&] { read_volume(folder() / "deep"); },
                 {"deep: found a folder with unknown kinds (letter.txt), NRRD (deeper/f.nrrd, "
                  "e.nrrd), expected the name of one of these"});
    std::filesystem::remove_all(folder() / "deep" / "deeper");
    std::filesystem::remove(folder() / "deep" / "e.nrrd");
    expect_error([&] { read_volume(folder() / "deep"); },
                 {"deep: found a folder with unknown kinds (letter.txt), expected a volume: NRRD"});
}

TEST_F(VolumeFiles, IncludeTheDataFileOfAHeader) {
    write("a.raw", "\x07\x09");
    const auto detached = write("a.nhdr", small_header + "data file: a.raw\n");
    EXPECT_EQ(files_of_volume(detached), (Paths{detached, folder() / "a.raw"}));
    const auto bad = write("b.nrrd", "nothing");
    EXPECT_EQ(files_of_volume(bad), Paths{bad});
}

}  // namespace
}  // namespace lamina
