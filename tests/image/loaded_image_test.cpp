// SPDX-License-Identifier: Apache-2.0
#include "image/picture.h"

#include <gtest/gtest.h>

#include "base/output_file.h"
#include "image/difference.h"
#include "image/exr.h"
#include "image/npy.h"
#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lamina {
namespace {

class LoadedImageTest : public testing::Test {
  protected:
    void write(const std::string& name, const PreciseImage& image) {
        AtomicFile file(folder / name);
        if (name.ends_with("exr")) write_exr(file, to_float(image), {});
        if (name.ends_with("npy")) write_npy(file, image);
        if (name.ends_with("png") || name.ends_with("PNG")) {
            write_png(file, to_float(image), glm::dvec3(0));
        }
        file.commit();
    }
    double linf(const std::string& a, const std::string& b) {
        return measure(difference(load_image(folder / a), load_image(folder / b))).all.linf;
    }

    TemporaryFolder folder;
};

TEST_F(LoadedImageTest, LinearFilesCompareWithEachOtherAndPngWithPng) {
    PreciseImage image(2, 2);
    for (double& value : image.rgba) value = 0.5;
    write("a.exr", image);
    write("a.png", image);
    image.pixel(1, 1)[0] = 0.75;
    write("b.npy", image);
    write("b.PNG", image);
    EXPECT_EQ(linf("a.exr", "b.npy"), 63.75);
    EXPECT_EQ(linf("b.npy", "a.exr"), 63.75);
    EXPECT_EQ(linf("a.exr", "a.exr"), 0);
    EXPECT_EQ(linf("a.png", "b.PNG"), 225 - 188);  // sRGB of .75 is .880825
}

TEST_F(LoadedImageTest, RefusalsToCompareNameTheFiles) {
    write("a.exr", PreciseImage(2, 3));
    write("a.png", PreciseImage(2, 3));
    write("b.npy", PreciseImage(4, 3));
    expect_error([&] { linf("a.png", "a.exr"); }, {"a.png", "a.exr", "sRGB codes"});
    expect_error([&] { linf("a.exr", "b.npy"); }, {"a.exr", "b.npy", "2 x 3", "4 x 3"});
    expect_error([&] { load_image(folder / "c.tiff"); }, {"c.tiff", "'.tiff'", ".exr"});
}

TEST_F(LoadedImageTest, LinearLightIsNotComparedWithDisplayValues) {
    const PreciseImage image(2, 2);
    write("a.exr", image);
    write("a.npy", image);
    for (const char* const name : {"b.exr", "c.exr"}) {
        AtomicFile file(folder / name);
        write_exr(file, to_float(image), {{"software", "test"}}, ImageColorSpace::display);
        file.commit();
    }
    EXPECT_EQ(color_space_of_exr(folder / "a.exr"), ImageColorSpace::linear);
    EXPECT_EQ(color_space_of_exr(folder / "b.exr"), ImageColorSpace::display);
    EXPECT_EQ(linf("b.exr", "c.exr"), 0);
    EXPECT_EQ(linf("b.exr", "a.npy"), 0);  // NPY files do not say which colour space they have
    for (const auto& [a, b] : {std::pair("a.exr", "b.exr"), {"b.exr", "a.exr"}})
        expect_error([&] { linf(a, b); }, {a, b, "linear light", "display values", "color_space"});
}

TEST_F(LoadedImageTest, NonFiniteValuesAreErrorsNamingPixelAndChannel) {
    PreciseImage image(2, 2);
    image.pixel(0, 1)[1] = 7;
    write("a.npy", image);
    std::string bytes = read_bytes_of(folder / "a.npy");
    const std::string seven("\0\0\0\0\0\0\x1C\x40", 8);
    bytes.replace(bytes.find(seven), 8, std::string("\0\0\0\0\0\0\xF8\x7F", 8));  // a quiet NaN
    write_bytes_to(folder / "a.npy", bytes);
    expect_error([&] { load_image(folder / "a.npy"); }, {"a.npy", "(0, 1)", "channel G", "nan"});
}

}  // namespace
}  // namespace lamina
