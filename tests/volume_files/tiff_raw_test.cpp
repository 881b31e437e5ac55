// SPDX-License-Identifier: Apache-2.0
// Pages of TIFF files whose samples lie there as they are: which are read without libtiff, and that
// their values are those that libtiff would give.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "base/client.h"
#include "base/error.h"
#include "expect_boxes.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/tiff_file.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

constexpr std::size_t columns = 6, rows = 5;

// Makes TIFF files of two pages without compression, whose strips follow each other.
struct RawTiff {
    bool is_big = false;  // the order of bytes
    std::size_t samples = 1, bits = 8, rows_per_strip = 2;
    bool planar = false;
    std::size_t photometric = 1, fill_order = 1;
    std::size_t more_strips = 0;  // named behind those that the page needs
    std::size_t more_bytes = 0;   // named for the last strip beyond what it needs

    std::size_t page_bytes() const { return columns * rows * samples * bits / 8; }

    void add(std::string& bytes, std::size_t number, std::size_t count) const {
        for (std::size_t i = 0; i < count; ++i)
            bytes += static_cast<char>(number >> 8 * (is_big ? count - 1 - i : i) & 255);
    }

    // Returns the file. `pixels`: the bytes of both pages.
    std::string file(const std::string& pixels) const {
        std::string bytes = is_big ? "MM" : "II";
        add(bytes, 42, 2);
        add(bytes, 8 + pixels.size(), 4);
        bytes += pixels;
        for (std::size_t page = 0; page < 2; ++page) add_page(bytes, page);
        return bytes;
    }

  private:
    struct Tag {
        std::size_t number, type;  // 3: 16 bits, 4: 32 bits
        std::vector<std::size_t> values;
    };

    void add_page(std::string& bytes, std::size_t page) const {
        const std::size_t row = columns * bits / 8 * (planar ? 1 : samples);
        std::vector<std::size_t> begins, counts;
        std::size_t at = 8 + page * page_bytes();
        for (std::size_t plane = 0; plane < (planar ? samples : 1); ++plane) {
            for (std::size_t y = 0; y < rows; y += rows_per_strip) {
                begins.push_back(at);
                counts.push_back(std::min(rows_per_strip, rows - y) * row);
                at += counts.back();
            }
        }
        counts.back() += more_bytes;
        begins.insert(begins.end(), more_strips, 8);
        counts.insert(counts.end(), more_strips, row);
        std::vector<Tag> tags{{256, 3, {columns}},
                              {257, 3, {rows}},
                              {258, 3, std::vector(samples, bits)},
                              {259, 3, {1}},
                              {262, 3, {photometric}},
                              {266, 3, {fill_order}},
                              {273, 4, begins},
                              {277, 3, {samples}},
                              {278, 3, {rows_per_strip}},
                              {279, 4, counts},
                              {284, 3, {planar ? 2u : 1u}}};
        if (photometric == 6) tags.push_back({530, 3, {1, 1}});  // colours of each pixel
        // Values of more than four bytes lie behind the directory.
        std::size_t behind = bytes.size() + 2 + 12 * tags.size() + 4;
        std::string values;
        add(bytes, tags.size(), 2);
        for (const auto& [number, type, list] : tags) {
            const std::size_t each = type == 3 ? 2 : 4;
            std::string all;
            for (const std::size_t value : list) add(all, value, each);
            add(bytes, number, 2);
            add(bytes, type, 2);
            add(bytes, list.size(), 4);
            all.resize(std::max<std::size_t>(all.size(), 4));
            if (all.size() == 4) {
                bytes += all;
            } else {
                add(bytes, behind + values.size(), 4);
                values += all;
            }
        }
        add(bytes, page == 0 ? behind + values.size() : 0, 4);
        bytes += values;
    }
};

class RawTiffs : public ::testing::Test {
  protected:
    std::filesystem::path write(const RawTiff& tiff) {
        pixels = test::noise_bytes(2 * tiff.page_bytes());
        write_bytes_to(folder / "a.tif", tiff.file(pixels));
        return folder / "a.tif";
    }

    // Returns one channel's samples, row by row, in this machine's byte order.
    std::string channel_of(const RawTiff& tiff, std::size_t channel) const {
        const std::size_t word = tiff.bits / 8, plane = columns * rows;
        std::string samples;
        for (std::size_t page = 0; page < 2; ++page) {
            for (std::size_t i = 0; i < plane; ++i) {
                const std::size_t place =
                    tiff.planar ? channel * plane + i : i * tiff.samples + channel;
                std::string sample = pixels.substr(page * tiff.page_bytes() + place * word, word);
                if (tiff.is_big != (std::endian::native == std::endian::big))
                    std::ranges::reverse(sample);
                samples += sample;
            }
        }
        return samples;
    }

    TemporaryFolder folder;
    std::string pixels;
    test::HeardWarnings heard;
};

TEST_F(RawTiffs, HaveTheirSamplesInBothByteOrdersAndLayouts) {
    for (const bool is_big : {false, true}) {
        for (const bool planar : {false, true}) {
            for (const std::size_t samples : {std::size_t{1}, std::size_t{3}}) {
                for (const std::size_t bits : {std::size_t{8}, std::size_t{16}}) {
                    if (planar && samples == 1) continue;
                    RawTiff tiff{is_big, samples, bits};
                    tiff.planar = planar;
                    const auto path = write(tiff);
                    SCOPED_TRACE(fmt::format("{} {} {} {}", is_big, planar, samples, bits));
                    EXPECT_EQ(TiffFile(path).page().raw, 8u);
                    for (std::size_t channel = 0; channel < samples; ++channel) {
                        VolumeRequest request;
                        if (samples > 1) request.channel = static_cast<std::int64_t>(channel);
                        const Volume volume = read_volume(path, request);
                        const std::string expected = channel_of(tiff, channel);
                        ASSERT_EQ(volume.grid().size,
                                  (std::array<std::int64_t, 3>{columns, rows, 2}));
                        EXPECT_EQ(std::memcmp(volume.data(), expected.data(), expected.size()), 0);
                    }
                }
            }
        }
    }
}

TEST_F(RawTiffs, MayNameMoreStripsAndBytesThanTheyNeed) {
    for (const auto& [strips, bytes] : {std::pair{1u, 0u}, {0u, 7u}, {3u, 7u}}) {
        RawTiff tiff;
        tiff.more_strips = strips;
        tiff.more_bytes = bytes;
        const auto path = write(tiff);
        SCOPED_TRACE(fmt::format("{} strips, {} bytes", strips, bytes));
        EXPECT_EQ(TiffFile(path).page().raw, 8u);
        EXPECT_EQ(std::memcmp(read_volume(path).data(), pixels.data(), pixels.size()), 0);
    }
}

// libtiff turns the bits of each byte.
TEST_F(RawTiffs, AreDecodedIfTheirBitsAreInTheOtherOrder) {
    RawTiff tiff;
    tiff.fill_order = 2;
    const auto path = write(tiff);
    EXPECT_FALSE(TiffFile(path).page().raw);
    const Volume volume = read_volume(path);
    const auto* const samples = static_cast<const unsigned char*>(volume.data());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        unsigned turned = 0;
        for (unsigned bit = 0; bit < 8; ++bit)
            turned |= (static_cast<unsigned char>(pixels[i]) >> bit & 1u) << (7 - bit);
        ASSERT_EQ(samples[i], turned) << i;
    }
}

// libtiff may convert them; with colours of each pixel, their strips are as long as those of RGB.
TEST_F(RawTiffs, AreNotReadAsTheyAreIfTheyAreYCbCr) {
    RawTiff tiff;
    tiff.samples = 3;
    tiff.photometric = 6;
    EXPECT_FALSE(TiffFile(write(tiff)).page().raw);
    tiff.photometric = 2;
    EXPECT_TRUE(TiffFile(write(tiff)).page().raw);
}

TEST_F(RawTiffs, EndTheWalkOverTheirStripsWhenAStopIsRequested) {
    const TiffFile file(write({}));
    std::stop_source stop;
    stop.request_stop();
    const ClientScope scope({stop.get_token()});
    EXPECT_THROW(file.page(), Interrupted);
}

}  // namespace
}  // namespace lamina
