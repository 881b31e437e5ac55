// SPDX-License-Identifier: Apache-2.0
#include "volume/volume_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/stored_volume.h"
#include "support/temporary_folder.h"
#include "support/volume_of.h"

namespace lamina {
namespace {

const Grid grid = test::grid_of({70, 37, 45}, Centering::node);

template <typename Sample>
Volume waves() {
    return test::volume_of<Sample>(grid, [](double x, double y, double z) {
        const double value = 100 + 90 * std::sin(x / 5) * std::cos(y / 7 + z / 3);
        return x > 30 && y > 10 && y < 20 ? 0 : value;
    });
}

Volume holes() {
    return test::volume_of<float>(grid, [](double x, double y, double z) {
        if (x < 9 && y < 9 && z < 9) return std::numeric_limits<double>::quiet_NaN();
        return x * y - 40 * z;
    });
}

void expect_equal(const VolumeIndex& index, const Volume& volume) {
    const MinMaxBricks bricks = measure_bricks(volume);
    ValueCounts values = count_values(volume);
    std::ranges::sort(values.some);
    ASSERT_EQ(index.bricks.ranges.size(), bricks.ranges.size());
    for (std::size_t i = 0; i < bricks.ranges.size(); ++i)
        EXPECT_EQ(index.bricks.range(i), bricks.range(i)) << i;
    EXPECT_EQ(index.bricks.count, bricks.count);
    EXPECT_EQ(index.bricks.whole, bricks.whole);
    EXPECT_EQ(index.bricks.non_finite, bricks.non_finite);
    EXPECT_EQ(index.values.codes, values.codes);
    EXPECT_EQ(index.values.some, values.some);
}

// The index, made in whole rows or in blocks, is that of the volume in memory.
TEST(VolumeIndex, MatchesWhatIsMeasuredInMemory) {
    for (const Volume& volume : {waves<std::uint8_t>(), waves<std::int16_t>(),
                                 waves<std::uint16_t>(), waves<float>(), holes()}) {
        for (const std::array<std::int64_t, 3>& block :
             {std::array<std::int64_t, 3>{0, 0, 0}, {16, 33, 10}, {100, 100, 100}})
            expect_equal(measure_index(test::stored(volume, block)), volume);
    }
}

class VolumeIndexFile : public ::testing::Test {
  protected:
    std::filesystem::path file() const { return folder_ / "volume.lamina-index"; }
    FoundIndex read(const std::string& identity) const {
        return read_index_file(file(), identity, grid, SampleType::float32);
    }
    void write() {
        write_index_file(file(), "here", grid, SampleType::float32,
                         measure_index(test::stored(holes())));
    }

    TemporaryFolder folder_;
};

TEST_F(VolumeIndexFile, IsReadAsItWasWritten) {
    write();
    const FoundIndex found = read("here");
    ASSERT_TRUE(found.index);
    expect_equal(*found.index, holes());
}

TEST_F(VolumeIndexFile, IsStaleForOtherSamples) {
    write();
    EXPECT_FALSE(read("elsewhere").index);
    EXPECT_EQ(read("elsewhere").wrong, "the index is of other samples");
    EXPECT_EQ(read_index_file(file(), "here", grid, SampleType::uint8).wrong,
              "the index is of other samples");
    EXPECT_EQ(read_index_file(folder_ / "none", "here", grid, SampleType::uint8).wrong, "");
}

TEST_F(VolumeIndexFile, IsOnlyReadFromARegularFile) {
    ASSERT_EQ(mkfifo(file().c_str(), 0600), 0);
    EXPECT_EQ(read("here").wrong, "the index is not a regular file");
    std::filesystem::remove(file());
    std::filesystem::create_symlink("/dev/zero", file());
    EXPECT_EQ(read("here").wrong, "the index is not a regular file");
}

TEST_F(VolumeIndexFile, NeverFollowsALinkAndReplacesNothingElse) {
    write_bytes_to(folder_ / "precious", "data");
    std::filesystem::create_symlink(folder_ / "precious", file());
    EXPECT_THROW(write(), Error);
    EXPECT_THROW(expect_index_or_nothing(file()), Error);
    EXPECT_EQ(read_bytes_of(folder_ / "precious"), "data");
    std::filesystem::remove(file());
    expect_index_or_nothing(file());
    write_bytes_to(file(), "data");
    EXPECT_THROW(expect_index_or_nothing(file()), Error);
    std::filesystem::remove(file());
    write();
    expect_index_or_nothing(file());
}

// An index file that is cut short anywhere, or has any byte changed, is rejected.
TEST_F(VolumeIndexFile, IsNotUsedIfDamaged) {
    write();
    const std::string bytes = read_bytes_of(file());
    const auto put = [&](const std::string& text) { write_bytes_to(file(), text); };
    for (std::size_t kept = 0; kept < bytes.size(); kept += 1 + bytes.size() / 300) {
        put(bytes.substr(0, kept));
        EXPECT_FALSE(read("here").index) << kept;
        EXPECT_EQ(read("here").wrong, "the index is damaged") << kept;
    }
    const std::size_t header = bytes.find('\n', bytes.find('\n') + 1);
    for (std::size_t at = 0; at < bytes.size(); at += at < header ? 1 : 1 + bytes.size() / 300) {
        std::string changed = bytes;
        changed[at] = static_cast<char>(changed[at] ^ 64);
        put(changed);
        EXPECT_FALSE(read("here").index) << at;
    }
}

}  // namespace
}  // namespace lamina
