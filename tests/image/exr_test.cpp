// SPDX-License-Identifier: Apache-2.0
#include "image/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "base/output_file.h"
#include "image/test_images.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"

namespace lamina {
namespace {

void write(const std::filesystem::path& path, const Image& image,
           const std::map<std::string, std::string>& attributes = {}) {
    AtomicFile file(path);
    write_exr(file, image, attributes);
    file.commit();
}

// Writes a file of half-float channels with the given names. Channel k of pixel i is i + 10 k,
// which a half float holds exactly.
void write_half(const std::filesystem::path& path, const std::vector<std::string>& names,
                const Imath::Box2i& window) {
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    const auto pixels = width * static_cast<std::size_t>(window.max.y - window.min.y + 1);
    std::vector<std::vector<Imath::half>> values;
    Imf::FrameBuffer buffer;
    for (std::size_t k = 0; k < names.size(); ++k) {
        std::vector<Imath::half>& channel = values.emplace_back(pixels);
        for (std::size_t i = 0; i < pixels; ++i) channel[i] = static_cast<float>(i + 10 * k);
        header.channels().insert(names[k], Imf::Channel(Imf::HALF));
        buffer.insert(names[k], Imf::Slice::Make(Imf::HALF, channel.data(), window));
    }
    Imf::OutputFile output(path.c_str(), header);
    output.setFrameBuffer(buffer);
    output.writePixels(window.max.y - window.min.y + 1);
}

const Imath::Box2i two_by_three({-5, 40}, {-4, 42});

TEST(Exr, KeepsEveryBit) {
    const TemporaryFolder folder;
    // The height is no multiple of 16, the lines of a ZIP block.
    const Image image = random_image(37, 19);
    write(folder / "a.exr", image);
    const Image back = read_exr(folder / "a.exr");
    ASSERT_EQ(back.width, 37);
    ASSERT_EQ(back.height, 19);
    EXPECT_EQ(std::memcmp(back.rgba.data(), image.rgba.data(), image.rgba.size() * sizeof(float)),
              0);
}

TEST(Exr, StoresZippedFloatsAndTheScene) {
    const TemporaryFolder folder;
    write(folder / "a.exr", random_image(4, 3), {{"lamina_scene", "{\n  \"version\": 1}"}});
    const Imf::InputFile file((folder / "a.exr").c_str());
    const Imf::Header& header = file.header();
    EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
    int channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channels) {
        EXPECT_NE(std::strchr("RGBA", c.name()[0]), nullptr);
        EXPECT_EQ(c.channel().type, Imf::FLOAT);
    }
    EXPECT_EQ(channels, 4);
    const auto* text = header.findTypedAttribute<Imf::StringAttribute>("lamina_scene");
    ASSERT_NE(text, nullptr);
    EXPECT_EQ(text->value(), "{\n  \"version\": 1}");
}

TEST(Exr, EqualImagesMakeEqualFiles) {
    const TemporaryFolder folder;
    const Image image = random_image(40, 40);
    write(folder / "a.exr", image, {{"b", "1"}, {"a", "2"}});
    write(folder / "b.exr", image, {{"a", "2"}, {"b", "1"}});
    EXPECT_EQ(read_bytes_of(folder / "a.exr"), read_bytes_of(folder / "b.exr"));
}

TEST(Exr, ReadsHalfAtAnyDataWindow) {
    const TemporaryFolder folder;
    write_half(folder / "a.exr", {"A", "B", "G", "R"}, two_by_three);
    const Image image = read_exr(folder / "a.exr");
    ASSERT_EQ(image.width, 2);
    ASSERT_EQ(image.height, 3);
    for (int i = 0; i < 6; ++i) {
        const float* const pixel = image.pixel(i % 2, i / 2);
        for (int channel = 0; channel < 4; ++channel) {
            EXPECT_EQ(pixel[channel], static_cast<float>(i + 10 * (3 - channel)));
        }
    }
}

TEST(Exr, MissingAlphaIsOpaqueAndYIsGray) {
    const TemporaryFolder folder;
    write_half(folder / "rgb.exr", {"R", "G", "B"}, two_by_three);
    EXPECT_EQ(read_exr(folder / "rgb.exr").pixel(1, 2)[0], 5);
    EXPECT_EQ(read_exr(folder / "rgb.exr").pixel(1, 2)[3], 1);
    write_half(folder / "y.exr", {"Y"}, two_by_three);
    const Image grey = read_exr(folder / "y.exr");
    for (int channel = 0; channel < 3; ++channel) EXPECT_EQ(grey.pixel(1, 2)[channel], 5);
    EXPECT_EQ(grey.pixel(1, 2)[3], 1);
}

TEST(Exr, RefusesChannelsOtherThanRgbaAndY) {
    const TemporaryFolder folder;
    write_half(folder / "rg.exr", {"R", "G"}, two_by_three);
    expect_error([&] { read_exr(folder / "rg.exr"); }, {"rg.exr", "G, R", "expected R, G, B"});
    write_half(folder / "chroma.exr", {"Y", "RY", "BY"}, two_by_three);
    expect_error([&] { read_exr(folder / "chroma.exr"); }, {"BY, RY, Y"});
    write_half(folder / "layer.exr", {"diffuse.R", "diffuse.G", "diffuse.B"}, two_by_three);
    expect_error([&] { read_exr(folder / "layer.exr"); }, {"diffuse.R"});
}

TEST(Exr, DamagedFilesAreErrors) {
    const TemporaryFolder folder;
    write(folder / "a.exr", random_image(3, 2));
    const std::string bytes = read_bytes_of(folder / "a.exr");
    // Flipped bits in the magic number, in sizes, types and offsets are refused; those in a pixel
    // cannot be noticed.
    EXPECT_GT(refusals_of_damaged(bytes, folder / "b.exr", read_exr), 50);
}

TEST(Exr, PromisedSizesAreCheckedBeforeMemoryIsTaken) {
    const TemporaryFolder folder;
    write(folder / "a.exr", random_image(3, 2));
    // Zeros at the end take the place of the table of lines (8 bytes for 16 lines), so that OpenEXR
    // itself accepts the header.
    const std::string bytes = read_bytes_of(folder / "a.exr") + std::string(10240, '\0');
    const auto with_window = [&](std::int32_t width, std::int32_t height) {
        std::string changed = bytes;
        // The value of the attribute (xMin, yMin, xMax, yMax) follows its name, its type "box2i"
        // and the length 16.
        const std::size_t value = changed.find("dataWindow") + 11 + 6 + 4;
        const std::int32_t corners[4] = {0, 0, width - 1, height - 1};
        std::memcpy(changed.data() + value, corners, sizeof corners);
        write_bytes_to(folder / "b.exr", changed);
        return error_of([&] { read_exr(folder / "b.exr"); });
    };
    EXPECT_NE(with_window(1000000, 1000000), "");
    EXPECT_NE(with_window(std::numeric_limits<std::int32_t>::max(), 2), "");
    EXPECT_NE(with_window(20000, 20000).find("20000 x 20000"), std::string::npos);
    EXPECT_NE(with_window(8192, 8192).find("1073741824 bytes"), std::string::npos);
    EXPECT_NE(with_window(0, 2), "");
}

// OpenEXR allocates as much memory as the length of an attribute, or the number of tiles, asks for.
TEST(Exr, AttributesThatPromiseTooMuchAreErrors) {
    const TemporaryFolder folder;
    write(folder / "a.exr", random_image(3, 2));
    const std::string good = read_bytes_of(folder / "a.exr");
    // Replaces an attribute (name, type, size and value) by another.
    const std::string head("screenWindowWidth\0float\0\4\0\0\0", 28);
    const std::size_t at = good.find(head), rest = at + head.size() + 4;
    ASSERT_NE(at, std::string::npos);
    const auto with_attribute = [&](const std::string& name, const std::string& type,
                                    std::uint32_t size, const std::string& value) {
        std::string bytes = good.substr(0, at) + name + '\0' + type + '\0';
        bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
        write_bytes_to(folder / "b.exr", bytes + value + good.substr(rest));
        return [&] { read_exr(folder / "b.exr"); };
    };
    const std::string four("\1\0\0\0", 4), most("\xff\xff\xff\x7f", 4);
    expect_error(with_attribute("mine", "other", 0x7fffffff, four),
                 {"b.exr", "\"mine\" of type \"other\"", "2147483647 bytes", "left"});
    expect_error(with_attribute("x", "float", 3, "abc"), {"\"x\" of type \"float\"", "3 bytes"});
    expect_error(with_attribute("x", "stringvector", 8, most + four), {"\"stringvector\""});
    expect_error(with_attribute("x", "preview", 12, most + most + four), {"\"preview\""});
    expect_error(with_attribute("x", "chlist", 4, "abc" + four.substr(1, 1)), {"\"chlist\""});
    expect_error(with_attribute("chunkCount", "int", 4, most), {"2147483647 tiles"});
    const std::string window("\0\0\0\0\0\0\0\0\xff\x3f\0\0\xff\x3f\0\0", 16);
    const std::string tiled = std::string("dataWindow\0box2i\0\x10\0\0\0", 21) + window;
    expect_error(with_attribute("tiles", "tiledesc", 9, four + four + '\0' + tiled),
                 {"268435456 tiles"});  // 16384 x 16384 tiles of one pixel
}

TEST(Exr, RefusesFilesThatAreNotImages) {
    const TemporaryFolder folder;
    expect_error([&] { read_exr(folder / "absent.exr"); }, {"absent.exr", "No such file"});
    expect_error([&] { read_exr(folder.path()); }, {"not a regular file"});
    write_bytes_to(folder / "text.exr", "this is not an image at all");
    expect_error([&] { read_exr(folder / "text.exr"); }, {"text.exr", "OpenEXR"});
}

TEST(Exr, RefusesToWriteWhatIsNotFinite) {
    const TemporaryFolder folder;
    Image image(5, 4);
    image.pixel(3, 2)[1] = std::numeric_limits<float>::quiet_NaN();
    expect_error([&] { write(folder / "a.exr", image); }, {"a.exr", "(3, 2)", "channel G", "nan"});
    expect_error([&] { write(folder / "a.exr", Image()); }, {"a.exr", "0 x 0"});
    EXPECT_TRUE(folder.empty());
}

TEST(Exr, FullDiskIsAnErrorAndLeavesNothing) {
    const TemporaryFolder folder;
    const Image image = random_image(100, 100);  // 160 kB that deflate cannot shrink to 20 kB
    {
        const FileSizeLimit limit(20000);
        expect_error([&] { write(folder / "a.exr", image); }, {"a.exr", "cannot write"});
    }
    EXPECT_TRUE(folder.empty());
}

// Annotations are a layer of their own: the picture's channels are those without it, bit for bit.
TEST(Exr, HasAnnotationsInALayerThatReadersOfThePictureIgnore) {
    const TemporaryFolder folder;
    Image image = random_image(37, 19);
    write(folder / "plain.exr", image);
    auto layer = std::make_shared<Image>(37, 19);
    layer->pixel(3, 5)[1] = 0.25f;
    layer->pixel(3, 5)[3] = 0.5f;
    image.annotations = layer;
    write(folder / "annotated.exr", image);
    const Image back = read_exr(folder / "annotated.exr");
    EXPECT_EQ(std::memcmp(back.rgba.data(), image.rgba.data(), image.rgba.size() * sizeof(float)),
              0);
    EXPECT_EQ(back.annotations, nullptr);

    Imf::InputFile file((folder / "annotated.exr").c_str());
    std::string names;
    for (auto it = file.header().channels().begin(); it != file.header().channels().end(); ++it)
        names += std::string(it.name()) + " ";
    EXPECT_EQ(names, "A B G R annotation.A annotation.B annotation.G annotation.R ");
    std::vector<float> green(37 * 19);
    Imf::FrameBuffer buffer;
    buffer.insert("annotation.G",
                  Imf::Slice::Make(Imf::FLOAT, green.data(), file.header().dataWindow()));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 18);
    EXPECT_EQ(green[5 * 37 + 3], 0.25f);
    Imf::InputFile plain((folder / "plain.exr").c_str());
    EXPECT_EQ(plain.header().channels().findChannel("annotation.R"), nullptr);
}

}  // namespace
}  // namespace lamina
