// SPDX-License-Identifier: Apache-2.0
#include "volume_files/volume_formats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "nrrd_files.h"

namespace lamina {
namespace {

using testing::bytes_of_values;
using testing::gzip;
using testing::samples_of;
using Nrrd = testing::WrittenFiles;

std::string header(const std::string& type, const std::string& encoding,
                   const std::string& endian = "little", const std::string& more = "") {
    return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 4 3 2\nendian: " + endian +
           "\nencoding: " + encoding + "\n" + more + "\n";
}

template <typename T>
std::vector<T> test_values() {
    std::vector<T> values;
    for (int i = 0; i < 24; ++i)
        values.push_back(static_cast<T>(i * 257 - (std::is_signed_v<T> ? 3000 : 0)));
    return values;
}

template <typename T>
std::string as_text(const std::vector<T>& values) {
    std::string text;
    for (const T value : values)
        text += std::to_string(static_cast<double>(value)) + (text.size() % 3 ? " " : "\n");
    return text;
}

template <typename T>
void expect_samples(const std::filesystem::path& path, SampleType type) {
    const Volume volume = open_nrrd(path);
    EXPECT_EQ(volume.type(), type) << path;
    EXPECT_EQ(volume.grid().size, (std::array<std::int64_t, 3>{4, 3, 2})) << path;
    EXPECT_EQ(samples_of<T>(volume), test_values<T>()) << path;
}

// Reads a type in every encoding and byte order, with the header attached and detached.
template <typename T, typename Files>
void expect_all_encodings(Files write, const std::string& name, SampleType type) {
    const auto values = test_values<T>();
    for (const bool big : {false, true}) {
        const std::string endian = big ? "big" : "little";
        const std::string raw = bytes_of_values(values, big);
        expect_samples<T>(write("raw.nrrd", header(name, "raw", endian) + raw), type);
        expect_samples<T>(write("gzip.nrrd", header(name, "gzip", endian) + gzip(raw)), type);
        expect_samples<T>(write("text.nrrd", header(name, "ascii", endian) + as_text(values)),
                          type);
        write("data.bin", "two\nlines\nxyz" + raw + "tail");
        expect_samples<T>(
            write("detached.nhdr",
                  header(name, "raw", endian, "line skip: 2\nbyte skip: 3\ndata file: data.bin\n")),
            type);
        write("end.bin", "any number of bytes before" + raw);
        expect_samples<T>(
            write("end.nhdr", header(name, "raw", endian, "byte skip: -1\ndata file: end.bin\n")),
            type);
        write("data.gz", "a line\n" + gzip("skip" + raw));
        expect_samples<T>(
            write("packed.nhdr",
                  header(name, "gz", endian, "line skip: 1\nbyte skip: 4\ndatafile: data.gz\n")),
            type);
    }
}

TEST_F(Nrrd, ReadsUint8InEveryEncoding) {
    expect_all_encodings<std::uint8_t>([&](auto... a) { return write(a...); }, "uint8",
                                       SampleType::uint8);
}
TEST_F(Nrrd, ReadsInt16InEveryEncoding) {
    expect_all_encodings<std::int16_t>([&](auto... a) { return write(a...); }, "short",
                                       SampleType::int16);
}
TEST_F(Nrrd, ReadsUint16InEveryEncoding) {
    expect_all_encodings<std::uint16_t>([&](auto... a) { return write(a...); }, "uint16",
                                        SampleType::uint16);
}
TEST_F(Nrrd, ReadsFloatInEveryEncoding) {
    expect_all_encodings<float>([&](auto... a) { return write(a...); }, "float",
                                SampleType::float32);
}

TEST_F(Nrrd, ReadsBzip2) {
    // bz2.compress(bytes(range(24))) of Python.
    const std::vector<unsigned char> packed = {
        0x42, 0x5a, 0x68, 0x39, 0x31, 0x41, 0x59, 0x26, 0x53, 0x59, 0xf7, 0xcd, 0x3b,
        0x61, 0x00, 0x00, 0x00, 0x60, 0x00, 0x7f, 0xff, 0xff, 0x80, 0x20, 0x00, 0x22,
        0x80, 0x01, 0xa6, 0x86, 0x4c, 0x85, 0x06, 0x8d, 0x1a, 0x0c, 0x80, 0xd1, 0x5c,
        0xf8, 0x46, 0x53, 0xa5, 0x6d, 0x7c, 0x64, 0x34, 0x3b, 0xe7, 0x48, 0xfc, 0x8b,
        0xf1, 0x77, 0x24, 0x53, 0x85, 0x09, 0x0f, 0x7c, 0xd3, 0xb6, 0x10};
    const std::string data(packed.begin(), packed.end());
    const Volume volume = open_nrrd(write("a.nrrd", header("uint8", "bzip2") + data));
    std::vector<std::uint8_t> expected(24);
    for (std::size_t i = 0; i < 24; ++i) expected[i] = static_cast<std::uint8_t>(i);
    EXPECT_EQ(samples_of<std::uint8_t>(volume), expected);
}

TEST_F(Nrrd, ReadsGzipOfSeveralMembers) {
    const std::string raw = bytes_of_values(test_values<std::uint8_t>());
    expect_samples<std::uint8_t>(
        write("a.nrrd", header("uint8", "gzip") + gzip(raw.substr(0, 10)) + gzip(raw.substr(10))),
        SampleType::uint8);
}

TEST_F(Nrrd, ReadsLinesThatEndInCarriageReturns) {
    std::string text;
    for (const char c : header("uint8", "raw")) {
        if (c == '\n') text += '\r';
        text += c;
    }
    expect_samples<std::uint8_t>(
        write("a.nrrd", text + bytes_of_values(test_values<std::uint8_t>())), SampleType::uint8);
}

TEST_F(Nrrd, KeepsNanAndInfinity) {
    const std::string text =
        "NRRD0001\ntype: float\ndimension: 3\nsizes: 3 1 1\nencoding: ascii\n\nnan -inf +2.5e0\n";
    const auto values = samples_of<float>(open_nrrd(write("a.nrrd", text)));
    EXPECT_TRUE(std::isnan(values[0]));
    EXPECT_EQ(values[1], -std::numeric_limits<float>::infinity());
    EXPECT_EQ(values[2], 2.5f);
}

Grid grid_of(const std::filesystem::path& path) {
    return open_nrrd(path).grid();
}

TEST_F(Nrrd, PlacesSamplesByOriginAndDirections) {
    const std::string more =
        "space: left-posterior-superior\nspace directions: (0,2,0) (-3,0,0) (0,0,0.5)\n"
        "space origin: (10,20,30)\ncenters: cell node ???\n";
    const Grid grid =
        grid_of(write("a.nrrd", header("uint8", "raw", "little", more) + std::string(24, 'x')));
    EXPECT_EQ(grid.to_world({1, 0, 0}), glm::dvec3(10, 22, 30));
    EXPECT_EQ(grid.to_world({0, 1, 0}), glm::dvec3(7, 20, 30));
    EXPECT_EQ(grid.to_world({0, 0, 1}), glm::dvec3(10, 20, 30.5));
    EXPECT_EQ(grid.centering, (std::array{Centering::cell, Centering::node, Centering::node}));
}

TEST_F(Nrrd, PlacesSamplesBySpacingsAndMins) {
    const std::string more =
        "spacings: 2 3 NaN\naxis mins: 10 20 30\naxis maxs: NaN NaN 34\ncenters: cell node cell\n";
    const Grid grid =
        grid_of(write("a.nrrd", header("uint8", "raw", "little", more) + std::string(24, 'x')));
    EXPECT_EQ(grid.to_world({0, 0, 0}),
              glm::dvec3(11, 20, 31));  // an axis min of cells is the first cell's border
    EXPECT_EQ(grid.to_world({1, 1, 1}), glm::dvec3(13, 23, 33));  // two cells of 2 in 30..34
}

TEST_F(Nrrd, PlacesSamplesAtWholeNumbersByDefault) {
    const Grid grid = grid_of(write("a.nrrd", header("uint8", "raw") + std::string(24, 'x')));
    EXPECT_EQ(grid.bounds().min, glm::dvec3(0));
    EXPECT_EQ(grid.bounds().max, glm::dvec3(3, 2, 1));
}

TEST_F(Nrrd, DropsAxesOfOneSampleBeyondThree) {
    const std::string text =
        "NRRD0004\ntype: uint8\ndimension: 5\nsizes: 1 4 1 3 1\nspace dimension: 3\n"
        "space directions: none (1,0,0) none (0,2,0) (0,0,3)\nencoding: raw\n\n";
    const Grid grid = grid_of(write("a.nrrd", text + std::string(12, 'x')));
    EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{4, 3, 1}));
    EXPECT_EQ(grid.step[2], glm::dvec3(0, 0, 3));
    EXPECT_EQ(grid.centering[2], Centering::cell);
}

TEST_F(Nrrd, ReadsWhatItWrites) {
    Grid grid;
    grid.size = {4, 3, 2};
    grid.centering = {Centering::node, Centering::cell, Centering::node};
    const double c = std::sqrt(0.75);  // numbers of 17 digits
    grid.step = {glm::dvec3{c, 0.5, 0} / 3.0, glm::dvec3{-0.5, c, 0} / 7.0,
                 glm::dvec3{0, 0, -1 / 3.0}};
    grid.origin = {1e-17, -1e10 / 3, 0.1};
    const auto values = std::make_shared<std::vector<std::int16_t>>(test_values<std::int16_t>());
    const Volume volume(grid, SampleType::int16,
                        std::shared_ptr<const void>(values, values->data()));
    AtomicFile file(folder() / "a.nrrd");
    write_nrrd(file, volume);
    file.commit();
    const Volume again = open_nrrd(folder() / "a.nrrd");
    EXPECT_EQ(again.type(), SampleType::int16);
    EXPECT_EQ(again.grid().size, grid.size);
    EXPECT_EQ(again.grid().centering, grid.centering);
    EXPECT_EQ(again.grid().step, grid.step);
    EXPECT_EQ(again.grid().origin, grid.origin);
    EXPECT_EQ(samples_of<std::int16_t>(again), *values);
}

}  // namespace
}  // namespace lamina
