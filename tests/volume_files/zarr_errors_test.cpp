// SPDX-License-Identifier: Apache-2.0
// Zarr arrays that are damaged, or promise what their chunks cannot hold.
#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "volume_files/isolated_process.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using nlohmann::json;

class ZarrErrors : public ::testing::Test {
  protected:
    // Returns the .zarray of a good array of 2 x 3 x 4 bytes in one chunk.
    static json good() {
        return {{"zarr_format", 2},      {"shape", {2, 3, 4}}, {"chunks", {2, 3, 4}},
                {"dtype", "|u1"},        {"order", "C"},       {"fill_value", 0},
                {"compressor", nullptr}, {"filters", nullptr}};
    }
    std::filesystem::path write(const json& array, const std::string& chunk) {
        std::filesystem::create_directories(folder / "a.zarr");
        write_bytes_to(folder / "a.zarr/.zarray", array.dump());
        write_bytes_to(folder / "a.zarr/0.0.0", chunk);
        return folder / "a.zarr";
    }
    void expect_bad(const json& array, std::initializer_list<std::string> parts,
                    const std::string& chunk = std::string(24, 'x')) {
        const auto path = write(array, chunk);
        SCOPED_TRACE(array.dump());
        expect_error([&] { read_volume(path); }, parts);
    }
    void expect_bad_key(const char* key, const json& value,
                        std::initializer_list<std::string> parts) {
        json array = good();
        array[key] = value;
        expect_bad(array, parts);
    }

    TemporaryFolder folder;
};

TEST_F(ZarrErrors, NameBadKeysOfTheArray) {
    EXPECT_EQ(read_volume(write(good(), std::string(24, 'x'))).grid().sample_count(), 24);
    for (const char* const key :
         {"zarr_format", "shape", "chunks", "dtype", "order", "fill_value", "compressor"}) {
        json array = good();
        array.erase(key);
        expect_bad(array, {".zarray", key, "found none"});
    }
    expect_bad_key("zarr_format", 3, {"zarr_format", "found 3", "expected 2"});
    expect_bad_key("shape", json({2, 0, 4}), {"shape", "[2,0,4]"});
    expect_bad_key("shape", "big", {"shape", "big"});
    expect_bad_key("chunks", json({2, 3}), {"chunks", "found 2", "expected 3"});
    expect_bad_key("chunks", json({100000, 100000, 100000}), {"chunks", "2 GiB"});
    expect_bad_key("dtype", "<c16", {"dtype", "<c16"});
    expect_bad_key("dtype", json({{"a", "<i2"}}), {"dtype", "expected a number"});
    expect_bad_key("order", "A", {"order", "\"A\""});
    expect_bad_key("compressor", json({{"id", "zfpy"}}), {"compressor", "zfpy", "blosc"});
    expect_bad_key("compressor", 5, {"compressor", "found 5"});
    expect_bad_key("dimension_separator", "-", {"dimension_separator", "\"-\""});
    expect_bad_key("fill_value", "x", {"fill_value", "\"x\""});
}

TEST_F(ZarrErrors, NameBadChunks) {
    expect_bad(good(), {"0.0.0", "found 23 bytes", "expected 24"}, std::string(23, 'x'));
    for (const char* const codec : {"zlib", "gzip", "zstd", "lz4", "blosc"}) {
        json array = good();
        array["compressor"] = {{"id", codec}};
        expect_bad(array, {"0.0.0", "damaged", codec});
        expect_bad(array, {"0.0.0"}, "");
    }
    json array = good();
    array["dimension_separator"] = "/";
    expect_bad(array, {"found no chunk", "0/0/0"});
}

// Takes no memory for samples that the small files cannot hold.
TEST_F(ZarrErrors, RefuseLargePromisesOfSmallFiles) {
    json array = good();
    array["shape"] = {100000, 100000, 100};
    array["chunks"] = {1000, 1000, 100};
    expect_bad(array, {"promises 1000000000000 bytes", "24"});
    array["chunks"] = {1, 1, 1};
    expect_bad(array, {"chunks", "at most 1000000"});
    array["shape"] = {1000000000000, 1000000000000, 1000000000000};
    array["chunks"] = {1000000, 1000, 1};
    expect_bad(array, {"chunks"});
    array = good();
    array["compressor"] = {{"id", "zlib"}};
    array["shape"] = array["chunks"] = {1000, 1000, 100};
    expect_bad(array, {"cannot hold"}, "x");
}

TEST_F(ZarrErrors, NameBadKeysOfImages) {
    write(good(), std::string(24, 'x'));
    const auto bad = [&](const json& image, std::initializer_list<std::string> parts) {
        const json attributes{{"multiscales", json::array({image})}};
        write_bytes_to(folder / ".zattrs", attributes.dump());
        SCOPED_TRACE(attributes.dump());
        expect_error([&] { read_volume(folder.path()); }, parts);
    };
    const json zyx{"z", "y", "x"};
    bad({{"axes", zyx}}, {"datasets"});
    bad({{"axes", zyx}, {"datasets", {{{"path", 3}}}}}, {"datasets", "path"});
    bad({{"axes", zyx}, {"datasets", {{{"path", "none"}}}}}, {"none"});
    bad({{"axes", {"z", "y", "q"}}, {"datasets", {{{"path", "a.zarr"}}}}}, {"axes", "\"q\""});
    bad({{"axes", {"z", "y", "y"}}, {"datasets", {{{"path", "a.zarr"}}}}}, {"two \"y\""});
    bad({{"datasets", {{{"path", "a.zarr"}}}}}, {"found 3 axes, expected 5"});
    const auto transformed = [&](const json& step) {
        return json{{"axes", zyx},
                    {"datasets",
                     {{{"path", "a.zarr"}, {"coordinateTransformations", json::array({step})}}}}};
    };
    bad(transformed({{"type", "scale"}, {"scale", {1, 2}}}), {"scale", "3 numbers"});
    bad(transformed({{"type", "scale"}, {"scale", {1, 0, 2}}}), {"axis 1", "distance of 0"});
    bad(transformed({{"type", "affine"}}), {"affine"});
}

// A library that crashes or hangs in an isolated process does not end this one.
TEST(IsolatedRead, CrashesAndHangsAreErrors) {
    expect_error(
        [] { read_isolated("a.h5", "libx", [](IsolatedLine&) -> ReadSamples { std::abort(); }); },
        {"a.h5", "libx ended with signal"});
    expect_error(
        [] {
            read_isolated("a.h5", "libx", [](IsolatedLine&) -> ReadSamples { fail("a.h5: no"); });
        },
        {"a.h5: no"});
    expect_error(
        [] {
            read_isolated("a.h5", "libx", [](IsolatedLine&) -> ReadSamples {
                for (volatile bool never = false; !never;) {
                }
                return {};
            });
        },
        {"a.h5", "libx does not come to an end"});
}

}  // namespace
}  // namespace lamina
