// SPDX-License-Identifier: Apache-2.0
#include "image/apng.h"

#include <gtest/gtest.h>

#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

CodedImage frame(int width, int channels, std::uint16_t code) {
    CodedImage image(width, 2, channels, 8);
    for (std::uint16_t& one : image.codes) one = code;
    return image;
}

std::string bytes_of_film(const std::vector<CodedImage>& frames, int rate) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.apng");
    AnimatedPng film(file, static_cast<std::uint32_t>(frames.size()), rate);
    for (const CodedImage& image : frames) film.add(encode_png(image));
    film.end();
    file.commit();
    return read_bytes_of(folder / "a.apng");
}

// Programs that do not know APNG show the first frame. Films are decoded in
// tests/cli/film_test.cpp.
TEST(AnimatedPng, IsAPngOfItsFirstFrame) {
    const TemporaryFolder folder;
    for (const int channels : {3, 4}) {
        const CodedImage first = frame(5, channels, 7);
        write_bytes_to(folder / "a.png", bytes_of_film({first, frame(5, channels, 9)}, 10));
        const CodedImage back = read_png(folder / "a.png");
        EXPECT_EQ(back.channels, channels);
        EXPECT_EQ(back.codes, first.codes);
    }
}

// The PNG specification: acTL has the number of frames and of plays (0: for ever), fcTL number,
// size, place, delay as a fraction, and two bytes; fcTL and fdAT are numbered together.
TEST(AnimatedPng, ChunksAreNumberedAndSayTheRate) {
    using namespace std::string_literals;
    const std::string film = bytes_of_film({frame(5, 3, 7), frame(5, 3, 8), frame(5, 3, 9)}, 260);
    EXPECT_NE(film.find("\0\0\0\x08"s + "acTL\0\0\0\x03\0\0\0\0"s), std::string::npos);
    const auto control = [](char number) {
        return "\0\0\0\x1a"s + "fcTL\0\0\0"s + number + "\0\0\0\x05\0\0\0\x02"s +
               std::string(8, '\0') + "\0\x01\x01\x04\0\0"s;
    };
    std::size_t at = 0;
    for (const std::string& next : {control(0), "IDAT"s, control(1), "fdAT\0\0\0\x02"s, control(3),
                                    "fdAT\0\0\0\x04"s, "IEND"s}) {
        at = film.find(next, at);
        ASSERT_NE(at, std::string::npos) << next;
    }
}

TEST(AnimatedPng, RefusesFramesThatDiffer) {
    const TemporaryFolder folder;
    AtomicFile file(folder / "a.apng");
    AnimatedPng film(file, 2, 25);
    const std::string first = encode_png(frame(5, 3, 7));
    film.add(first);
    expect_error([&] { film.add(encode_png(frame(4, 3, 7))); }, {"differ in size"});
    expect_error([&] { film.add(encode_png(frame(5, 4, 7))); }, {"or kind"});
    expect_error([&] { film.add(first.substr(0, first.size() - 3)); }, {"no whole PNG"});
    expect_error([&] { film.add(""); }, {"no whole PNG"});
}

}  // namespace
}  // namespace lamina
