// SPDX-License-Identifier: Apache-2.0
// Volumes that stay in their files give the same samples as in memory, box by box.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "expect_boxes.h"
#include "nrrd_files.h"
#include "support/heard_warnings.h"
#include "volume/volume_store.h"
#include "volume_files/stored_data.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

namespace fs = std::filesystem;

using test::in_files;
using test::noise_bytes;

void expect_boxes(const fs::path& path, const VolumeRequest& request = {}) {
    SCOPED_TRACE(path);
    test::expect_boxes(read_volume(path, request), open_volume(path, request, in_files));
}

class StoredSources : public testing::WrittenFiles {
  protected:
    fs::path nrrd(const std::string& name, const std::string& fields, const std::string& data) {
        return write(name, "NRRD0004\n" + fields + "\n" + data);
    }
    fs::path zarr(const nlohmann::json& changes) {
        nlohmann::json array{{"zarr_format", 2},      {"shape", {23, 17, 31}},
                             {"chunks", {8, 9, 16}},  {"dtype", "|u1"},
                             {"order", "C"},          {"fill_value", 7},
                             {"compressor", nullptr}, {"filters", nullptr}};
        array.merge_patch(changes);
        array["compressor"] = nullptr;
        array["filters"] = nullptr;
        fs::create_directories(folder_ / "a.zarr");
        write("a.zarr/.zarray", array.dump());
        const std::size_t bytes = array["dtype"] == "|u1" ? 1 : 2;
        for (int z = 0; z < 3; ++z)
            for (int y = 0; y < 2; ++y)
                for (int x = 0; x < 2; ++x)
                    if (x + y + z != 2)  // missing chunks have the fill value
                        write(fmt::format("a.zarr/{}.{}.{}", z, y, x),
                              noise_bytes(8 * 9 * 16 * bytes));
        return folder_ / "a.zarr";
    }
};

TEST_F(StoredSources, ReadBoxesOfRawFiles) {
    const std::string head = "dimension: 3\nsizes: 31 17 23\nencoding: raw\n";
    expect_boxes(nrrd("a.nrrd", "type: uint8\n" + head, noise_bytes(31 * 17 * 23)));
    for (const char* const endian : {"little", "big"}) {
        for (const char* const type : {"short", "ushort", "float"}) {
            expect_boxes(nrrd("b.nrrd", fmt::format("type: {}\nendian: {}\n{}", type, endian, head),
                              noise_bytes(4 * 31 * 17 * 23)));
        }
    }
    write("c.raw", "two\nlines\nand 9 byt" + noise_bytes(31 * 17 * 23));
    expect_boxes(nrrd(
        "c.nhdr", "type: uint8\n" + head + "line skip: 2\nbyte skip: 9\ndata file: c.raw\n", ""));
    VolumeRequest raw;
    raw.raw = RawLayout{{31, 17, 23}, "uint16", 3, true};
    expect_boxes(write("d.raw", noise_bytes(3 + 2 * 31 * 17 * 23)), raw);
    expect_boxes(write("e.mha",
                       "NDims = 3\nDimSize = 31 17 23\nElementType = MET_USHORT\n"
                       "ElementByteOrderMSB = True\nElementDataFile = LOCAL\n" +
                           noise_bytes(2 * 31 * 17 * 23)));
}

TEST_F(StoredSources, ReadBoxesOfNumPyArrays) {
    const auto npy = [&](const char* order) {
        std::string head =
            fmt::format("{{'descr': '>i2', 'fortran_order': {}, 'shape': (23, 17, 31), }}", order);
        head.resize(117, ' ');
        return write("a.npy", std::string("\x93NUMPY\x01\0\x76\0", 10) + head + "\n" +
                                  noise_bytes(2 * 31 * 17 * 23));
    };
    expect_boxes(npy("False"));
    expect_error([&] { open_volume(npy("True"), {}, in_files); }, {"a.npy", "first axis"});
}

TEST_F(StoredSources, ReadBoxesOfOneChannelAndOfFilesOfSlices) {
    VolumeRequest request;
    request.channel = 2;
    expect_boxes(nrrd("a.nrrd",
                      "type: uint8\ndimension: 4\nsizes: 3 31 17 23\nkinds: vector domain domain "
                      "domain\nencoding: raw\n",
                      noise_bytes(3 * 31 * 17 * 23)),
                 request);
    for (int i = 0; i < 23; ++i) write(fmt::format("s{}.raw", i), noise_bytes(31 * 17));
    expect_boxes(nrrd("b.nhdr",
                      "type: uint8\ndimension: 3\nsizes: 31 17 23\nencoding: raw\n"
                      "data file: s%d.raw 0 22 1\n",
                      ""));
}

TEST_F(StoredSources, ReadBoxesOfZarrArrays) {
    expect_boxes(zarr(nlohmann::json::object()));
    expect_boxes(zarr({{"order", "F"}}));
    expect_boxes(zarr({{"dtype", ">u2"}}));
}

// Holes are known to be 0 without reading them, if the file system reports them.
TEST_F(StoredSources, KnowThatHolesOfSparseFilesAreZero) {
    const std::string header =
        "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1024 1024 64\nencoding: raw\n\n";
    const fs::path path = write("a.nrrd", header);
    fs::resize_file(path, header.size() + 1024 * 1024 * 64);
    const int file = open(path.c_str(), O_WRONLY);
    const std::string data = noise_bytes(4096);
    const auto place = static_cast<off_t>(header.size() + 40 * 1024 * 1024 + 100 * 1024);
    ASSERT_EQ(pwrite(file, data.data(), data.size(), place), 4096);
    close(file);
    expect_boxes(path);
    const Volume volume = open_volume(path, {}, in_files);
    const SampleSource& source = volume.store().source();
    EXPECT_FALSE(source.known_as_zero({{0, 0, 0}, {1024, 1024, 64}}));
    EXPECT_FALSE(source.known_as_zero({{5, 101, 40}, {1, 1, 1}}));
    const int again = open(path.c_str(), O_RDONLY);
    const bool holes = lseek(again, 1 << 20, SEEK_DATA) > (1 << 20);  // reported by the file system
    close(again);
    EXPECT_EQ(source.known_as_zero({{0, 64, 0}, {1024, 900, 32}}), holes);
}

TEST_F(StoredSources, ReportThatAFileWasChanged) {
    const std::string head = "type: uint8\ndimension: 3\nsizes: 31 17 23\nencoding: raw\n";
    const fs::path path = nrrd("a.nrrd", head, noise_bytes(31 * 17 * 23));
    const Volume volume = open_volume(path, {}, in_files);
    const SampleSource& source = volume.store().source();
    source.check_unchanged();
    const std::string identity = source.identity();
    fs::resize_file(path, fs::file_size(path) - 100);
    std::string samples(31 * 17 * 23, '\0');
    expect_error(
        [&] {
            source.read({{0, 0, 0}, {31, 17, 23}}, samples.data());
        },
        {"a.nrrd", "truncated"});
    expect_error([&] { source.check_unchanged(); }, {"a.nrrd", "changed"});
    nrrd("a.nrrd", head, noise_bytes(31 * 17 * 23 - 1) + "x");
    fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(5));
    expect_error([&] { source.check_unchanged(); }, {"a.nrrd", "changed"});
    EXPECT_NE(open_volume(path, {}, in_files).store().source().identity(), identity);
}

TEST_F(StoredSources, AChunkThatChangesIsAnError) {
    const fs::path path = zarr(nlohmann::json::object());
    VolumeRequest unmeasured;  // no chunk is read before it changes
    unmeasured.lookup = VolumeLookup::linear;
    const Volume volume = open_volume(path, unmeasured, in_files);
    std::string samples(31 * 17 * 23, '\0');
    write("a.zarr/0.1.0", noise_bytes(8 * 9 * 16 - 3));
    expect_error(
        [&] {
            volume.store().source().read({{0, 0, 0}, {31, 17, 23}}, samples.data());
        },
        {"0.1.0", "changed"});
}

// Raw data inside a file of another format: what is behind them is no surplus.
TEST_F(StoredSources, PlaceRawDataAmongOtherBytes) {
    StoredData data;
    data.path = write("a.bin", "head" + std::string("12345678") + "behind");
    data.files = {data.path};
    data.axes = {2, 2, 2};
    const test::HeardWarnings heard;
    place_raw(data, 4);
    const StoredSamples samples = read_stored(data);
    EXPECT_EQ(std::string(static_cast<const char*>(samples.bytes.get()), 8), "12345678");
    EXPECT_TRUE(heard.texts.empty());
    write("a.bin", "head1234567");
    place_raw(data, 4);
    expect_error([&] { read_stored(data); }, {"a.bin", "8 bytes", "holds 7 bytes"});
    // Offsets of damaged files lie up to 2^62 bytes behind the file's begin.
    for (const std::uint64_t far : {(std::uint64_t{1} << 62) - 4, std::uint64_t{1} << 62}) {
        place_raw(data, far);
        EXPECT_EQ(data.byte_skip, static_cast<std::int64_t>(far));
        expect_error([&] { read_stored(data); }, {"a.bin", "8 bytes", "holds 0 bytes"});
    }
}

TEST_F(StoredSources, RefuseWhatMustBeReadAsAWhole) {
    const auto open = [](const fs::path& path) { open_volume(path, {}, in_files); };
    const std::string sizes = "dimension: 3\nsizes: 2 2 2\n";
    expect_error(
        [&] {
            open(nrrd("a.nrrd", "type: uint8\nencoding: ascii\n" + sizes, "1 2 3 4 5 6 7 8\n"));
        },
        {"a.nrrd", "not raw", "Zarr"});
    expect_error(
        [&] {
            open(nrrd("b.nrrd", "type: double\nendian: little\nencoding: raw\n" + sizes,
                      std::string(64, 0)));
        },
        {"b.nrrd", "double"});
}

}  // namespace
}  // namespace lamina
