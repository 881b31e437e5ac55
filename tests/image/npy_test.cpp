// SPDX-License-Identifier: Apache-2.0
#include "image/npy.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "base/output_file.h"
#include "cli/run_program.h"
#include "image/test_images.h"
#include "support/expect_error.h"
#include "support/file_size_limit.h"

namespace lamina {
namespace {

PreciseImage precise_image(int width, int height) {
    const Image image = random_image(width, height);
    PreciseImage precise(width, height);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        precise.rgba[i] = image.rgba[i] * (1 + 1e-12 * static_cast<double>(i));
    }
    return precise;
}

template <typename Real>
void save_npy(const std::filesystem::path& path, const RgbaImage<Real>& image) {
    AtomicFile file(path);
    write_npy(file, image);
    file.commit();
}

// Returns the bytes of a file with this header and `data_bytes` bytes of data.
std::string npy_bytes(const std::string& header, std::size_t data_bytes, char version = 1) {
    std::string bytes = std::string("\x93NUMPY") + version + '\0';
    const auto length = static_cast<std::uint32_t>(header.size());
    bytes.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
    return bytes + header + std::string(data_bytes, '\0');
}

std::string header_of(const std::string& descr, const std::string& order,
                      const std::string& shape) {
    return "{'descr': " + descr + ", 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

bool numpy_is_there() {
    return run_program({"/usr/bin/python3", "-c", "import numpy"}).exit_code == 0;
}

TEST(Npy, KeepsEveryBit) {
    const TemporaryFolder folder;
    const PreciseImage image = precise_image(7, 5);
    save_npy(folder / "a.npy", image);
    const PreciseImage back = read_npy(folder / "a.npy");
    ASSERT_EQ(back.width, 7);
    ASSERT_EQ(back.height, 5);
    EXPECT_EQ(back.rgba, image.rgba);
}

TEST(Npy, SinglePrecisionStaysSingle) {
    const TemporaryFolder folder;
    const Image image = random_image(7, 5);
    save_npy(folder / "a.npy", image);
    EXPECT_EQ((read_bytes_of(folder / "a.npy").size() - 7 * 5 * 4 * sizeof(float)) % 64, 0u);
    const PreciseImage back = read_npy(folder / "a.npy");
    ASSERT_EQ(back.width, 7);
    ASSERT_EQ(back.height, 5);
    for (std::size_t i = 0; i < back.rgba.size(); ++i)
        EXPECT_EQ(back.rgba[i], static_cast<double>(image.rgba[i]));
}

TEST(Npy, IsReadByNumpy) {
    if (!numpy_is_there()) GTEST_SKIP() << "skipped: no numpy";
    const TemporaryFolder folder;
    PreciseImage image(3, 2);
    for (std::size_t i = 0; i < image.rgba.size(); ++i) {
        image.rgba[i] = 1.0 / (static_cast<double>(i) + 3);
    }
    save_npy(folder / "a.npy", image);
    const ProgramResult result =
        run_program({"/usr/bin/python3", "-c",
                     "import numpy, sys\n"
                     "a = numpy.load(sys.argv[1])\n"
                     "b = 1.0 / (numpy.arange(24.0).reshape(2, 3, 4) + 3)\n"
                     "print(a.dtype.str, a.shape, a.flags.c_contiguous, bool((a == b).all()))",
                     folder / "a.npy"});
    EXPECT_EQ(result.out, "<f8 (2, 3, 4) True True\n") << result.err;
    // The data begin at a multiple of 64 bytes, as NEP 1 asks.
    EXPECT_EQ((read_bytes_of(folder / "a.npy").size() - 24 * sizeof(double)) % 64, 0u);
}

TEST(Npy, ReadsFilesOfNumpy) {
    if (!numpy_is_there()) GTEST_SKIP() << "skipped: no numpy";
    const TemporaryFolder folder;
    const ProgramResult result = run_program(
        {"/usr/bin/python3", "-c",
         "import numpy, sys\n"
         "a = numpy.arange(24.0).reshape(2, 3, 4) / 8\n"
         "numpy.save(sys.argv[1] + '/f8.npy', a)\n"
         "numpy.save(sys.argv[1] + '/f4.npy', a.astype('<f4'))\n"
         "numpy.save(sys.argv[1] + '/rgb.npy', numpy.ascontiguousarray(a[:, :, :3]))\n"
         "numpy.lib.format.write_array(open(sys.argv[1] + '/v2.npy', 'wb'), a, version=(2, 0))\n"
         "numpy.save(sys.argv[1] + '/big.npy', a.astype('>f8'))\n"
         "numpy.save(sys.argv[1] + '/fortran.npy', numpy.asfortranarray(a))\n",
         folder.path()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const char* name : {"f8.npy", "f4.npy", "rgb.npy", "v2.npy"}) {
        const PreciseImage image = read_npy(folder / name);
        ASSERT_EQ(image.width, 3) << name;
        ASSERT_EQ(image.height, 2) << name;
        for (std::size_t i = 0; i < image.rgba.size(); ++i) {
            const bool made_up = std::string(name) == "rgb.npy" && i % 4 == 3;
            EXPECT_EQ(image.rgba[i], made_up ? 1 : static_cast<double>(i) / 8) << name;
        }
    }
    expect_error([&] { read_npy(folder / "big.npy"); }, {"big.npy", "'>f8'", "expected '<f4'"});
    expect_error([&] { read_npy(folder / "fortran.npy"); }, {"fortran_order", "True"});
}

TEST(Npy, DamagedFilesAreErrors) {
    const TemporaryFolder folder;
    save_npy(folder / "a.npy", precise_image(2, 2));
    const std::string bytes = read_bytes_of(folder / "a.npy");
    // Damage is noticed at least in the magic number (6 bytes), the version, the length, and the
    // digits of the shape.
    EXPECT_GT(refusals_of_damaged(bytes, folder / "b.npy", read_npy), 12);
    write_bytes_to(folder / "longer.npy", bytes + "x");
    expect_error([&] { read_npy(folder / "longer.npy"); }, {"129 bytes", "expected 128"});
}

TEST(Npy, HeadersThatDoNotFitAreErrors) {
    const TemporaryFolder folder;
    const auto error = [&](const std::string& bytes) {
        write_bytes_to(folder / "a.npy", bytes);
        return error_of([&] { read_npy(folder / "a.npy"); });
    };
    const auto expect_named = [&](const std::string& header, const std::string& found) {
        EXPECT_NE(error(npy_bytes(header, 32)).find(found), std::string::npos)
            << error(npy_bytes(header, 32));
    };
    expect_named(header_of("'<i4'", "False", "(1, 1, 4)"), "'<i4'");
    expect_named(header_of("[('x', '<f8')]", "False", "(1, 1, 4)"), "descr");
    expect_named(header_of("'<f8'", "False", "(1, 4)"), "(1, 4)");
    expect_named(header_of("'<f8'", "False", "(1, 1, 4, 1)"), "(1, 1, 4, 1)");
    expect_named(header_of("'<f8'", "False", "(1, 1, 5)"), "(1, 1, 5)");
    expect_named(header_of("'<f8'", "False", "(1, 1, 4"), "shape");
    expect_named(header_of("'<f8'", "False", "(1, x, 4)"), "shape");
    expect_named(header_of("'<f8'", "False", "(-1, -1, 4)"), "-1");
    expect_named(header_of("'<f8'", "False", "(0, 1, 4)"), "0");
    expect_named(header_of("'<f8'", "False", "(99999999999999999999, 1, 4)"), "shape");
    expect_named(header_of("'<f8'", "False", "(1000000, 1000000, 4)"), "1000000 x 1000000");
    expect_named(header_of("'<f8'", "False", "(8192, 8192, 4)"), "2147483648");
    expect_named("{'descr': '<f8'}", "fortran_order");
    expect_named("", "descr");
    EXPECT_NE(error(npy_bytes("", 0, 9)).find("version 9"), std::string::npos);
    EXPECT_NE(error(npy_bytes(std::string(70000, ' '), 0, 2)).find("70000"), std::string::npos);
}

TEST(Npy, RefusesToWriteWhatIsNotFinite) {
    const TemporaryFolder folder;
    PreciseImage image(2, 2);
    image.pixel(1, 0)[2] = 1e300;  // beyond float32, so it cannot come from a renderer
    expect_error([&] { save_npy(folder / "a.npy", image); },
                 {"a.npy", "(1, 0)", "channel B", "1e+300"});
    EXPECT_TRUE(folder.empty());
}

TEST(Npy, FullDiskIsAnErrorAndLeavesNothing) {
    const TemporaryFolder folder;
    {
        const FileSizeLimit limit(20000);
        expect_error([&] { save_npy(folder / "a.npy", PreciseImage(50, 50)); },
                     {"a.npy", "cannot write"});
    }
    EXPECT_TRUE(folder.empty());
}

TEST(ToFloat, RoundsToNearest) {
    PreciseImage image(1, 1);
    image.rgba = {1.0 / 3, 1 + 0x1p-25, -2, 0};
    const Image rounded = to_float(image);
    EXPECT_EQ(rounded.width, 1);
    EXPECT_EQ(rounded.height, 1);
    EXPECT_EQ(rounded.rgba, (std::vector<float>{1.0f / 3, 1, -2, 0}));
}

}  // namespace
}  // namespace lamina
