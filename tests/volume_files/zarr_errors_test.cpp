// SPDX-License-Identifier: Apache-2.0
// Zarr arrays that are damaged, or promise what their chunks cannot hold.
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stop_token>

#include "base/client.h"
#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "volume_files/isolated_process.h"
#include "volume_files/volume_file.h"
#include "volume_files/zarr_array.h"

namespace lamina {
namespace {

using nlohmann::json;

// Writes an array of 2 x 3 x 4 bytes in one chunk, whose header, `good`, tests make bad.
class BadArrays : public ::testing::Test {
  protected:
    BadArrays(const char* header, json good) : header_(header), good_(std::move(good)) {}

    const json& good() const { return good_; }
    std::filesystem::path write(const json& array, const std::string& chunk) {
        std::filesystem::create_directories(folder / "a.zarr");
        write_bytes_to(folder / "a.zarr" / header_, array.dump());
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

  private:
    const char* header_;
    json good_;
};

class ZarrErrors : public BadArrays {
  protected:
    ZarrErrors()
        : BadArrays(".zarray", {{"zarr_format", 2},
                                {"shape", {2, 3, 4}},
                                {"chunks", {2, 3, 4}},
                                {"dtype", "|u1"},
                                {"order", "C"},
                                {"fill_value", 0},
                                {"compressor", nullptr},
                                {"filters", nullptr}}) {}
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

// Each filter takes a pass over every chunk; those that leave no trace count, too.
TEST_F(ZarrErrors, RefuseMoreThanEightFilters) {
    const json shuffle{{"id", "shuffle"}, {"elementsize", 1}};
    json array = good();
    array["filters"] = json(8, shuffle);
    EXPECT_EQ(read_volume(write(array, std::string(24, 'x'))).grid().sample_count(), 24);
    expect_bad_key("filters", json(9, shuffle), {"filters: found 9, expected at most 8"});
    expect_bad_key("filters", json(9, json{{"id", "bitround"}}),
                   {"filters: found 9, expected at most 8"});
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
    bad({{"axes", {"y", "x"}}, {"datasets", {{{"path", "a.zarr"}}}}}, {"found 3 axes, expected 2"});
    const auto transformed = [&](const json& step) {
        return json{{"axes", zyx},
                    {"datasets",
                     {{{"path", "a.zarr"}, {"coordinateTransformations", json::array({step})}}}}};
    };
    bad(transformed({{"type", "scale"}, {"scale", {1, 2}}}), {"scale", "3 numbers"});
    bad(transformed({{"type", "scale"}, {"scale", {1, 0, 2}}}), {"axis 1", "distance of 0"});
    bad(transformed({{"type", "affine"}}), {"affine"});
}

class Zarr3Errors : public BadArrays {
  protected:
    Zarr3Errors()
        : BadArrays("zarr.json",
                    {{"zarr_format", 3},
                     {"node_type", "array"},
                     {"shape", {2, 3, 4}},
                     {"data_type", "uint8"},
                     {"chunk_grid",
                      {{"name", "regular"}, {"configuration", {{"chunk_shape", {2, 3, 4}}}}}},
                     {"chunk_key_encoding", {{"name", "v2"}}},
                     {"codecs", json::array({"bytes"})},
                     {"fill_value", 0}}) {}
    // Returns the codec of files with chunks of 1 x 3 x 4 bytes, and an index without checksum.
    static json sharding() {
        const json words{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}};
        return {{"name", "sharding_indexed"},
                {"configuration",
                 {{"chunk_shape", {1, 3, 4}},
                  {"codecs", json::array({"bytes"})},
                  {"index_codecs", json::array({words})}}}};
    }
    static std::string entry(std::uint64_t begin, std::uint64_t bytes) {
        std::string text;
        for (const std::uint64_t number : {begin, bytes})
            for (int bit = 0; bit < 64; bit += 8) text += static_cast<char>(number >> bit & 0xff);
        return text;
    }
    // Expects the error of a fill value, which a chunk needs that is not there.
    void expect_bad_fill(const char* type, const json& fill) {
        json array = good();
        array["data_type"] = type;
        array["codecs"] = {{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}}};
        array["fill_value"] = fill;
        array["shape"] = {2, 3, 8};
        expect_bad(array, {"fill_value", "found " + fill.dump()});
    }
};

TEST_F(Zarr3Errors, NameWhatIsNotRead) {
    EXPECT_EQ(read_volume(write(good(), std::string(24, 'x'))).grid().sample_count(), 24);
    for (const char* const key : {"zarr_format", "node_type", "shape", "data_type", "chunk_grid",
                                  "chunk_key_encoding", "codecs", "fill_value"}) {
        json array = good();
        array.erase(key);
        expect_bad(array, {"zarr.json", key, "found none"});
    }
    const auto named = [](const char* name) { return json{{"name", name}}; };
    expect_bad_key("zarr_format", 4, {"zarr_format", "found 4", "expected 3"});
    expect_bad_key("node_type", "leaf", {"node_type", "leaf"});
    expect_bad_key("data_type", "complex64", {"data_type", "complex64"});
    expect_bad_key("data_type", {{"name", "numpy.datetime64"}}, {"data_type", "datetime64"});
    expect_bad_key("chunk_grid", named("rectilinear"), {"chunk_grid", "rectilinear", "regular"});
    expect_bad_key("chunk_key_encoding", named("odd"), {"chunk_key_encoding", "odd"});
    expect_bad_key("storage_transformers", json::array({named("mirror")}), {"mirror"});
    expect_bad_key("odd", named("odd"), {"extension \"odd\""});
    expect_bad_key("dimension_names", {"y", "x"}, {"dimension_names", "3 names"});
    expect_bad_key("codecs", json::array(), {"codecs", "bytes"});
    for (const char* const codec : {"numcodecs.lzma", "zlib", "vlen-utf8"})
        expect_bad_key("codecs", {"bytes", codec}, {"codecs", codec, "zstd"});
    expect_bad_key("codecs", {"gzip", "bytes"}, {"codecs", "gzip", "behind bytes"});
    expect_bad_key("codecs", {"bytes", "gzip", "zstd"}, {"zstd behind gzip"});
    for (const json& order : {json{0, 1}, json{0, 1, 1}, json{0, 1, 3}, json{0, 1, -1}}) {
        const json turn{{"name", "transpose"}, {"configuration", {{"order", order}}}};
        expect_bad_key("codecs", {turn, "bytes"}, {"transpose", order.dump()});
    }
    json array = good();
    array["data_type"] = "int16";
    expect_bad(array, {"endian", "found none"});
}

TEST_F(Zarr3Errors, NameBadFillValues) {
    for (const json& fill :
         {json("nan"), json("0x7fc0"), json("0x7fc00000000000000"), json(nullptr)})
        expect_bad_fill("float64", fill);
    for (const json& fill : {json(-1), json(256), json(1.5), json("NaN"), json("0x01")})
        expect_bad_fill("uint8", fill);
    expect_bad_fill("uint64", -1);
    expect_bad_fill("int64", std::uint64_t{1} << 63);
}

TEST_F(Zarr3Errors, NameBadChunks) {
    expect_bad(good(), {"0.0.0", "found 23 bytes", "expected 24"}, std::string(23, 'x'));
    for (const char* const codec : {"gzip", "zstd", "blosc", "crc32c"}) {
        json array = good();
        array["codecs"] = {"bytes", codec};
        expect_bad(array, {"0.0.0", "damaged", codec});
        expect_bad(array, {"0.0.0"}, "");
        array["codecs"] = {"bytes", codec, "crc32c"};
        expect_bad(array, {"0.0.0", "damaged crc32c"}, "x");
    }
}

TEST_F(Zarr3Errors, NameBadShards) {
    json array = good();
    array["codecs"] = {sharding()};
    const std::string samples(24, 'x');
    EXPECT_EQ(read_volume(write(array, samples + entry(0, 12) + entry(12, 12))).grid().size[2], 2);
    expect_bad(array, {"0.0.0", "chunk 1", "found 13 bytes from byte 44 on", "56"},
               samples + entry(0, 12) + entry(44, 13));
    constexpr std::uint64_t most = ~std::uint64_t{0};
    expect_bad(array, {"chunk 0", "from byte 18446744073709551614"},
               samples + entry(most - 1, 12) + entry(12, 12));
    expect_bad(array, {"chunk 1"}, samples + entry(0, 12) + entry(12, most));
    expect_bad(array, {"found 11 bytes, expected 12"}, samples + entry(0, 11) + entry(12, 12));
    expect_bad(array, {"cannot hold the index of the 2 chunks"}, std::string(31, 'x'));

    json& how = array["codecs"][0]["configuration"];
    how["index_codecs"].push_back("crc32c");
    expect_bad(array, {"index", "damaged crc32c"}, samples + entry(0, 12) + entry(12, 12) + "1234");
    how["index_codecs"].push_back("gzip");
    expect_bad(array, {"index_codecs", "gzip"});
    how = sharding()["configuration"];
    how["chunk_shape"] = {1, 2, 4};
    expect_bad(array, {"chunk_shape", "found 2", "divisor of 3"});
    how["chunk_shape"] = {1, 3};
    expect_bad(array, {"chunk_shape", "found 2 sizes"});
    how = sharding()["configuration"];
    how["index_location"] = "middle";
    expect_bad(array, {"index_location", "middle"});
    how = sharding()["configuration"];
    how["codecs"] = {sharding()};
    expect_bad(array, {"codecs", "sharding_indexed"});
    array["codecs"] = {sharding(), "gzip"};
    expect_bad(array, {"codecs", "gzip"});
}

TEST_F(Zarr3Errors, RefuseLargePromisesOfSmallFiles) {
    json array = good();
    const auto shape = [&](const json& whole, const json& file, const json& chunk) {
        array["shape"] = whole;
        array["chunk_grid"]["configuration"]["chunk_shape"] = file;
        array["codecs"] = {sharding()};
        array["codecs"][0]["configuration"]["chunk_shape"] = chunk;
    };
    shape({1000000, 1000000, 1000000}, {1000000, 1000000, 1000000}, {1, 1, 1});
    expect_bad(array, {"at most 1000000"});
    shape({1000, 1000, 1000000}, {1000, 1000, 1000000}, {10, 1000, 1000});
    expect_bad(array, {"cannot hold the index of the 100000 chunks"});
    shape({1000000, 1000000, 1000000}, {1000000, 1000000, 1000000}, {1000000, 1000, 1000000});
    expect_bad(array, {"2 GiB"});
    shape({2, 1000000, 1000000}, {2, 1000000, 1000000}, {2, 1000, 1000000});
    expect_bad(array, {"cannot hold"});
}

TEST(OtherStores, AreRefusedByName) {
    const TemporaryFolder folder;
    write_bytes_to(folder / "attributes.json", R"({"n5": "2.0.0"})");
    expect_error([&] { read_volume(folder.path()); }, {"N5", "expected Zarr"});
    std::filesystem::remove(folder / "attributes.json");
    write_bytes_to(folder / "info", R"({"@type": "neuroglancer_multiscale_volume"})");
    expect_error([&] { read_volume(folder.path()); }, {"Neuroglancer precomputed"});
}

// The loop over filters looks for a requested stop, which tasks of one chunk do not.
TEST(ZarrFilters, EndWhenAStopIsRequested) {
    std::stop_source stop;
    stop.request_stop();
    const ClientScope scope({stop.get_token()});
    std::array<char, 8> chunk{};
    const ZarrFilter filters[] = {{ZarrFilter::Kind::shuffle, 2}};
    EXPECT_THROW(undo_filters(filters, chunk), Interrupted);
    EXPECT_NO_THROW(undo_filters({}, chunk));
}

TEST(ZarrFilters, KeepTheSignOfAFirstZero) {
    const float stored[] = {-0.f, 1.f, -3.f}, expected[] = {-0.f, 1.f, -2.f};
    std::array<char, sizeof stored> chunk{};
    std::memcpy(chunk.data(), stored, sizeof stored);
    const ZarrFilter filters[] = {{ZarrFilter::Kind::delta, sizeof(float), false, true}};
    undo_filters(filters, chunk);
    EXPECT_EQ(std::memcmp(chunk.data(), expected, sizeof expected), 0);
    undo_filters(filters, {});  // no value at all
}

// A library that crashes or hangs in an isolated process does not end this one.
TEST(IsolatedRead, CrashesAndHangsAreErrors) {
    const auto filling = [](const std::function<void()>& fill) {
        isolated_bytes("a.h5", "libx", 1, 1, 1, 1,
                       [&](std::size_t, std::size_t, char*) { fill(); });
    };
    expect_error([&] { filling([] { std::abort(); }); }, {"a.h5", "libx ended with signal"});
    expect_error([&] { filling([] { fail("a.h5: no"); }); }, {"a.h5: no"});
    expect_error(
        [&] {
            filling([] {
                for (volatile bool never = false; !never;) {
                }
            });
        },
        {"a.h5", "libx does not come to an end"});
}

}  // namespace
}  // namespace lamina
