// SPDX-License-Identifier: Apache-2.0
// Converts samples of every type to the types that are drawn, and checks the warning about values
// that float32 does not hold.
#include "volume_files/stored_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/memory.h"
#include "support/heard_warnings.h"
#include "support/samples_of.h"
#include "volume_files/volume_opening.h"

namespace lamina {
namespace {

using testing::samples_of;

class DrawnSamples : public ::testing::Test {
  protected:
    template <typename T>
    Volume drawn(ValueType type, const std::vector<T>& values, double scale = 1,
                 double offset = 0) {
        warnings_.clear();
        StoredSamples samples{"a.file", type, filled_memory(values.size() * sizeof(T)), scale,
                              offset};
        std::memcpy(samples.bytes.get(), values.data(), values.size() * sizeof(T));
        return drawn_volume(plain_grid({static_cast<std::int64_t>(values.size()), 1, 1}), samples,
                            std::nullopt);
    }

    template <typename T>
    SampleType type_of(ValueType type, const std::vector<T>& values) {
        const Volume volume = drawn(type, values);
        volume.visit([&](const auto* samples) {
            for (std::size_t i = 0; i < values.size(); ++i)
                EXPECT_EQ(static_cast<double>(samples[i]), static_cast<double>(values[i]));
        });
        EXPECT_TRUE(warnings_.empty()) << warnings_[0];
        return volume.type();
    }

    test::HeardWarnings heard_;
    std::vector<std::string>& warnings_ = heard_.texts;
};

TEST_F(DrawnSamples, HaveTheFirstTypeThatHoldsAllIntegers) {
    using Values = std::vector<std::int64_t>;
    EXPECT_EQ(type_of<std::int8_t>(ValueType::int8, {-128, 127}), SampleType::int16);
    EXPECT_EQ(type_of<std::int8_t>(ValueType::int8, {0, 1}), SampleType::int16);
    EXPECT_EQ(type_of(ValueType::int64, Values{0, 255}), SampleType::uint8);
    EXPECT_EQ(type_of(ValueType::int64, Values{-1, 255}), SampleType::int16);
    EXPECT_EQ(type_of(ValueType::int64, Values{0, 256}), SampleType::int16);
    EXPECT_EQ(type_of(ValueType::int64, Values{-32768, 32767}), SampleType::int16);
    EXPECT_EQ(type_of(ValueType::int64, Values{0, 32768}), SampleType::uint16);
    EXPECT_EQ(type_of(ValueType::int64, Values{0, 65535}), SampleType::uint16);
    EXPECT_EQ(type_of(ValueType::int64, Values{0, 65536}), SampleType::float32);
    EXPECT_EQ(type_of(ValueType::int64, Values{-1, 32768}), SampleType::float32);
    EXPECT_EQ(type_of<std::uint32_t>(ValueType::uint32, {0, 1u << 31}), SampleType::float32);
    EXPECT_EQ(type_of<std::uint64_t>(ValueType::uint64, {7, 65535}), SampleType::uint16);
    EXPECT_EQ(type_of<std::uint64_t>(ValueType::uint64, {0, std::uint64_t{1} << 63}),
              SampleType::float32);
    EXPECT_EQ(type_of<std::int64_t>(ValueType::int64, {std::numeric_limits<std::int64_t>::min()}),
              SampleType::float32);
}

TEST_F(DrawnSamples, WarnOfIntegersThatFloatsCannotHold) {
    // 2^24 + 1 is the first whole number that float32 lacks; it becomes 2^24.
    drawn<std::int32_t>(ValueType::int32, {16777216, 16777217, -16777217, 5});
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(warnings_[0],
              "a.file: 2 of 4 int32 samples are rounded to float, by up to 1"
              ": \"lookup\": \"nearest\" in the volume keeps labels apart");
    drawn<std::int64_t>(ValueType::int64, {std::numeric_limits<std::int64_t>::max()});
    ASSERT_EQ(warnings_.size(), 1u);  // becomes 2^63
    EXPECT_EQ(warnings_[0],
              "a.file: 1 of 1 int64 samples are rounded to float, by up to 1"
              ": \"lookup\": \"nearest\" in the volume keeps labels apart");
    drawn<std::uint64_t>(ValueType::uint64, {std::numeric_limits<std::uint64_t>::max()});
    EXPECT_EQ(warnings_.size(), 1u);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const auto values = samples_of<float>(
        drawn<double>(ValueType::float64, {.1, .5, nan, infinity, -1e300, 1e-320}));
    EXPECT_EQ(values[0], .1F);
    EXPECT_TRUE(std::isnan(values[2]));
    EXPECT_EQ(values[3], std::numeric_limits<float>::infinity());
    EXPECT_EQ(values[4], -std::numeric_limits<float>::infinity());
    ASSERT_EQ(warnings_.size(), 2u);
    EXPECT_EQ(warnings_[0],
              "a.file: 2 of 6 double samples are rounded to float, by up to 1.49e-09");
    EXPECT_EQ(warnings_[1], "a.file: 1 of 6 double samples are beyond float, and infinite");
}

TEST_F(DrawnSamples, AreScaledInDoublePrecision) {
    const std::vector<std::uint16_t> stored{0, 1, 4095};
    const Volume hounsfield = drawn(ValueType::uint16, stored, 1, -1024);
    EXPECT_EQ(hounsfield.type(), SampleType::int16);
    EXPECT_EQ(samples_of<std::int16_t>(hounsfield),
              (std::vector<std::int16_t>{-1024, -1023, 3071}));
    const Volume negative = drawn<std::uint8_t>(ValueType::uint8, {0, 255}, -1, 255);
    EXPECT_EQ(samples_of<std::uint8_t>(negative), (std::vector<std::uint8_t>{255, 0}));
    const Volume real = drawn(ValueType::uint16, stored, .1, 3);
    EXPECT_EQ(samples_of<float>(real), (std::vector<float>{3, static_cast<float>(.1 + 3),
                                                           static_cast<float>(.1 * 4095 + 3)}));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(DrawnSamples, AreTheFilesOwnWhereTheirTypeIsDrawn) {
    StoredSamples samples{"a.file", ValueType::float32, filled_memory(8)};
    std::memset(samples.bytes.get(), 0, 8);
    EXPECT_EQ(drawn_volume(plain_grid({2, 1, 1}), samples, std::nullopt).data(),
              samples.bytes.get());
}

TEST(SwapBytes, TurnsWordsOfEverySize) {
    std::string bytes = "abcdefgh";
    swap_bytes(bytes.data(), 8, 1);
    EXPECT_EQ(bytes, "abcdefgh");
    swap_bytes(bytes.data(), 4, 2);
    EXPECT_EQ(bytes, "badcfehg");
    swap_bytes(bytes.data(), 2, 4);
    EXPECT_EQ(bytes, "cdabghef");
    swap_bytes(bytes.data(), 1, 8);
    EXPECT_EQ(bytes, "fehgbadc");
}

}  // namespace
}  // namespace lamina
