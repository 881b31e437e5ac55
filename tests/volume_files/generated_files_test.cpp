// SPDX-License-Identifier: Apache-2.0
// Files that generate_nrrd() writes hold the volumes that generate() returns.
#include <gtest/gtest.h>

#include <cstring>

#include "nrrd_files.h"
#include "volume/generate.h"

namespace lamina {
namespace {

using GenerateFiles = testing::WrittenFiles;

GeneratorRequest generator_request(const std::string& name, std::array<std::int64_t, 3> size,
                                   SampleType type) {
    return {name, size, type};
}

TEST_F(GenerateFiles, StreamedFileHoldsTheSameVolume) {
    for (const std::string& name : generator_names()) {
        for (const SampleType type : {SampleType::uint8, SampleType::uint16, SampleType::float32}) {
            const GeneratorRequest wanted = generator_request(name, {33, 20, 11}, type);
            AtomicFile file(folder() / "a.nrrd");
            generate_nrrd(file, wanted);
            file.commit();
            const Volume streamed = open_nrrd(folder() / "a.nrrd");
            const Volume whole = generate(wanted);
            EXPECT_EQ(streamed.type(), type);
            EXPECT_EQ(streamed.grid().step, whole.grid().step);
            EXPECT_EQ(streamed.grid().origin, whole.grid().origin);
            EXPECT_EQ(streamed.grid().centering, whole.grid().centering);
            ASSERT_EQ(streamed.byte_count(), whole.byte_count());
            EXPECT_EQ(std::memcmp(streamed.data(), whole.data(), whole.byte_count()), 0) << name;
        }
    }
}

TEST_F(GenerateFiles, ManySlabsMakeTheSameVolumeAsOne) {
    const GeneratorRequest wanted =
        generator_request("gaussians", {1100, 1000, 10}, SampleType::float32);  // 44 MB: 2 slabs
    AtomicFile file(folder() / "a.nrrd");
    generate_nrrd(file, wanted);
    file.commit();
    const Volume streamed = open_nrrd(folder() / "a.nrrd");
    const Volume whole = generate(wanted);
    ASSERT_EQ(streamed.byte_count(), whole.byte_count());
    EXPECT_EQ(std::memcmp(streamed.data(), whole.data(), whole.byte_count()), 0);
}

}  // namespace
}  // namespace lamina
