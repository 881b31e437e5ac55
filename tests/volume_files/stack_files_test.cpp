// SPDX-License-Identifier: Apache-2.0
// Files of stacks that name other files, list what they have, or can stay in their files.
#include <zlib.h>

#include <cstring>
#include <fstream>

#include "base/client.h"
#include "corpus_files.h"
#include "expect_boxes.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Path = std::filesystem::path;

constexpr int width = 6, height = 5;

// Appends numbers of 2 or 4 bytes, the lowest first.
void add16(std::string& bytes, std::size_t number) {
    for (int i = 0; i < 2; ++i) bytes += static_cast<char>(number >> 8 * i & 255);
}
void add32(std::string& bytes, std::size_t number) {
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i & 255);
}

// Returns a TIFF file of pages of 8 bits, with a description of the first.
std::string tiff_of(const std::string& pixels, std::size_t pages, const std::string& description) {
    std::string file("II*\0\0\0\0\0", 8);
    const std::size_t text = file.size(), data = text + description.size() + 1;
    file += description + '\0' + pixels;
    for (std::size_t page = 0; page < pages; ++page) {
        std::string at;
        add32(at, file.size());
        file.replace(page == 0 ? 4 : file.size() - 4, 4, at);
        const std::size_t first = data + page * width * height;
        // Tag, type (2: text, 3: 16 bits, 4: 32 bits), count, value.
        const std::size_t entries[][4] = {
            {256, 3, 1, width},  {257, 3, 1, height},
            {258, 3, 1, 8},      {259, 3, 1, 1},
            {262, 3, 1, 1},      {270, 2, description.size() + 1, text},
            {273, 4, 1, first},  {277, 3, 1, 1},
            {278, 3, 1, height}, {279, 4, 1, width * height}};
        add16(file, std::size(entries));
        for (const auto& [tag, type, count, value] : entries) {
            add16(file, tag);
            add16(file, type);
            add32(file, count);
            add32(file, value);
        }
        add32(file, 0);
    }
    return file;
}

VolumeRequest of_channel(std::int64_t channel) {
    VolumeRequest request;
    request.channel = channel;
    return request;
}

VolumeRequest of_array(const char* name) {
    VolumeRequest request;
    request.array = name;
    return request;
}

VolumeUse listing(VolumeContents& contents) {
    VolumeUse use;
    use.contents = &contents;
    return use;
}

void write(const Path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

// Returns the XML of a data set of two channels of two slices, each in a file of its own.
std::string set_of(const std::string& first, const std::string& second) {
    std::string parts;
    for (int channel = 0; channel < 2; ++channel)
        parts += fmt::format(
            "<TiffData FirstC=\"{0}\" IFD=\"0\" PlaneCount=\"2\"><UUID "
            "FileName=\"{1}\"/></TiffData>",
            channel, channel == 0 ? first : second);
    return fmt::format(
        "<OME><Image Name=\"i\"><Pixels DimensionOrder=\"XYZCT\" SizeX=\"{}\" SizeY=\"{}\" "
        "SizeZ=\"2\" SizeC=\"2\" SizeT=\"1\"><Channel Name=\"nuclei\"/><Channel Name=\"actin\"/>{}"
        "</Pixels></Image></OME>",
        width, height, parts);
}

TEST(OmeDataSets, CountAllTheirFilesAsRead) {
    const TemporaryFolder folder, elsewhere;
    const std::string xml = set_of("a.ome.tif", "b.ome.tif");
    const std::string pixels = test::noise_bytes(2 * width * height);
    write(folder / "a.ome.tif", tiff_of(pixels, 2, xml));
    write(folder / "b.ome.tif", tiff_of(pixels, 2, xml));
    const std::vector<Path> files = files_of_volume(folder / "a.ome.tif");
    EXPECT_EQ(files, (std::vector<Path>{folder / "a.ome.tif", folder / "b.ome.tif"}));
    VolumeContents contents;
    const Volume volume = open_volume(folder / "b.ome.tif", of_channel(1), listing(contents));
    EXPECT_EQ(std::memcmp(volume.data(), pixels.data(), pixels.size()), 0);
    EXPECT_EQ(contents.channels, (std::vector<std::string>{"nuclei", "actin"}));
    EXPECT_EQ(contents.arrays, (std::vector<std::string>{"i"}));
    EXPECT_TRUE(contents.times.empty());
    // A client that may read one folder only does not reach another by a name in the XML.
    const Path outside = elsewhere / "b.ome.tif";
    write(outside, tiff_of(pixels, 2, xml));
    write(folder / "a.ome.tif", tiff_of(pixels, 2, set_of("a.ome.tif", outside.string())));
    EXPECT_EQ(read_volume(folder / "a.ome.tif", of_channel(1)).grid().size[2], 2);
    const OnlyBelowScope below(folder.path());
    expect_error([&] { read_volume(folder / "a.ome.tif", of_channel(1)); },
                 {outside.string(), "not opened"});
}

TEST(ImageJStacks, BehindOnePageStayInTheirFile) {
    const TemporaryFolder folder;
    const std::string pixels = test::noise_bytes(12 * width * height);
    const std::string text = "ImageJ=1.53\nimages=12\nchannels=2\nslices=6\n";
    write(folder / "a.tif", tiff_of(pixels, 1, text));
    for (int channel = 0; channel < 2; ++channel) {
        const VolumeRequest request = of_channel(channel);
        const Volume whole = read_volume(folder / "a.tif", request);
        ASSERT_EQ(whole.grid().size, (std::array<std::int64_t, 3>{width, height, 6}));
        const auto* const samples = static_cast<const char*>(whole.data());
        // Planes hold the channels in turn.
        for (std::size_t z = 0; z < 6; ++z) {
            EXPECT_EQ(
                std::memcmp(samples + z * width * height,
                            &pixels[(2 * z + static_cast<std::size_t>(channel)) * width * height],
                            width * height),
                0);
        }
        test::expect_boxes(whole, open_volume(folder / "a.tif", request, test::in_files));
    }
    write(folder / "b.tif", tiff_of(pixels, 12, text));
    expect_error([&] { open_volume(folder / "b.tif", {}, test::in_files); },
                 {"b.tif", "do not lie in a row", "lamina index --bricks"});
}

// Pages of one channel, whose samples lie one behind the other, and two that change places.
TEST(TiffPages, InARowStayInTheirFile) {
    const TemporaryFolder folder;
    const std::string pixels = test::noise_bytes(4 * width * height);
    std::string file = tiff_of(pixels, 4, "ImageJ=1.53\nimages=4\nslices=4\n");
    write(folder / "a.tif", file);
    const test::HeardWarnings heard;
    const Volume whole = read_volume(folder / "a.tif");
    EXPECT_EQ(std::memcmp(whole.data(), pixels.data(), pixels.size()), 0);
    test::expect_boxes(whole, open_volume(folder / "a.tif", {}, test::in_files));
    EXPECT_TRUE(heard.texts.empty());
    // Page 3 takes the samples of page 2, whose place stands once in the file.
    std::string second, third;
    const std::size_t first = file.find(pixels), plane = width * height;
    add32(second, first + plane);
    add32(third, first + 2 * plane);
    file.replace(file.find(third, first + pixels.size()), 4, second);
    write(folder / "b.tif", file);
    const Volume changed = read_volume(folder / "b.tif");
    const auto* const samples = static_cast<const char*>(changed.data());
    EXPECT_EQ(std::memcmp(samples, pixels.data(), 2 * plane), 0);
    EXPECT_EQ(std::memcmp(samples + 2 * plane, &pixels[plane], plane), 0);
    EXPECT_EQ(std::memcmp(samples + 3 * plane, &pixels[3 * plane], plane), 0);
    expect_error([&] { open_volume(folder / "b.tif", {}, test::in_files); },
                 {"b.tif", "do not lie in a row"});
}

TEST(ImageJStacks, NameFramesByTheirTimes) {
    const TemporaryFolder folder;
    const std::string pixels = test::noise_bytes(6 * width * height);
    const std::string text = "ImageJ=1.53\nimages=6\nslices=2\nframes=3\nfinterval=2.5\n";
    VolumeContents contents;
    write(folder / "a.tif", tiff_of(pixels, 6, text));
    open_volume(folder / "a.tif", {}, listing(contents));
    EXPECT_EQ(contents.times, (std::vector<std::string>{"0 s", "2.5 s", "5 s"}));
    write(folder / "a.tif", tiff_of(pixels, 6, text + "tunit=min\n"));
    open_volume(folder / "a.tif", {}, listing(contents));
    EXPECT_EQ(contents.times, (std::vector<std::string>{"0 min", "2.5 min", "5 min"}));
    // Damaged files may name 2^20 frames: none repeats a text that is no unit.
    write(folder / "a.tif", tiff_of(pixels, 6, text + "tunit=" + std::string(33, 'm') + "\n"));
    open_volume(folder / "a.tif", {}, listing(contents));
    EXPECT_EQ(contents.times, (std::vector<std::string>{"0 ", "2.5 ", "5 "}));
}

TEST(OmeStacks, NameFramesByTheirTimes) {
    const TemporaryFolder folder;
    const std::string pixels = test::noise_bytes(2 * width * height);
    for (const auto& [unit, name] :
         {std::pair<std::string, std::string>{"ms", "1.5 ms"}, {std::string(33, 'm'), "1.5 "}}) {
        VolumeContents contents;
        write(folder / "a.ome.tif",
              tiff_of(pixels, 2,
                      fmt::format("<OME><Image><Pixels SizeX=\"6\" SizeY=\"5\" SizeT=\"2\" "
                                  "TimeIncrement=\"1.5\" TimeIncrementUnit=\"{}\"/></Image></OME>",
                                  unit)));
        open_volume(folder / "a.ome.tif", {}, listing(contents));
        EXPECT_EQ(contents.times.at(1), name);
    }
}

TEST(PictureStacks, RefuseASecondFrameOfAJpegFile) {
    // libjpeg reads on behind the marker TEM, FF 01; whoever takes what follows for a length skips
    // the picture, and comes to another frame header, of one pixel.
    const std::string good = testing::corpus_file("pictures/grey.jpg");
    std::string file = good.substr(0, 2) + "\xff\x01" + good.substr(2);
    file.resize(4 + (0xff00 | static_cast<unsigned char>(file[5])));
    file += std::string("\xff\xc0\0\x0b\x08\0\1\0\1\1\1\x11\0", 13);
    const TemporaryFolder folder;
    write(folder / "a.jpg", file);
    expect_error([&] { read_volume(folder / "a.jpg"); },
                 {"a.jpg: damaged: libjpeg finds 6 x 4 pixels", "expected 1 x 1 pixels"});
}

TEST(TiffStacks, ListChannelsTimesAndColours) {
    const TemporaryFolder folder;
    const std::string pixels = test::noise_bytes(20 * width * height);
    VolumeContents contents;
    write(folder / "a.tif", tiff_of(pixels, 20, "{\"shape\": [5, 4, 5, 6]}"));
    open_volume(folder / "a.tif", {}, listing(contents));
    EXPECT_EQ(contents.times.size(), 5u);
    EXPECT_TRUE(contents.channels.empty());
    EXPECT_FALSE(contents.is_colour);
    expect_error([&] { read_volume(folder / "a.tif", of_array("x")); }, {"a.tif: array"});
}

// Returns a stored ZIP archive of one member.
std::string zip_of(const std::string& name, const std::string& contents) {
    const auto crc = static_cast<std::size_t>(crc32(
        0, reinterpret_cast<const Bytef*>(contents.data()), static_cast<uInt>(contents.size())));
    const auto add_sizes = [&](std::string& to) {
        add32(to, crc);
        add32(to, contents.size());
        add32(to, contents.size());
        add16(to, name.size());
    };
    std::string file("PK\3\4\24\0\0\0\0\0\0\0\0\0", 14);
    add_sizes(file);
    add16(file, 0);
    file += name + contents;
    const std::size_t directory = file.size();
    file += std::string("PK\1\2\24\0\24\0\0\0\0\0\0\0\0\0", 16);
    add_sizes(file);
    file += std::string(16, '\0') + name;
    const std::size_t bytes = file.size() - directory;
    file += std::string("PK\5\6\0\0\0\0\1\0\1\0", 12);
    add32(file, bytes);
    add32(file, directory);
    add16(file, 0);
    return file;
}

TEST(NumpyArchives, ThatAreNotCompressedStayInTheirFile) {
    const TemporaryFolder folder;
    std::string array("\x93NUMPY\1\0\x76\0", 10);
    array += "{'descr': '<i2', 'fortran_order': False, 'shape': (4, 5, 6), }";
    array.resize(128, ' ');
    array += test::noise_bytes(4 * 5 * 6 * 2);
    const std::string archive = zip_of("v.npy", array);
    write(folder / "a.npz", archive);
    test::expect_boxes(read_volume(folder / "a.npz"),
                       open_volume(folder / "a.npz", of_array("v"), test::in_files));
    std::string damaged = archive;
    damaged[200] = static_cast<char>(damaged[200] ^ 1);
    write(folder / "b.npz", damaged);
    expect_error([&] { read_volume(folder / "b.npz"); }, {"b.npz: v.npy: damaged: its CRC is"});
    test::HeardWarnings heard;
    read_volume(folder / "a.npz");
    EXPECT_EQ(heard.all(), "");  // an archive of one array has nothing to choose
    expect_error([&] { read_volume(folder / "a.npz", of_array("w")); },
                 {"array: found \"w\", expected one of \"v\""});
}

}  // namespace
}  // namespace lamina
