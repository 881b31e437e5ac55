// SPDX-License-Identifier: Apache-2.0
// Names, sizes of levels and units of a Zarr hierarchy, and links in it: what is used, and what is
// said.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class ZarrHierarchies : public ::testing::Test {
  protected:
    void write(const std::string& name, const json& document) {
        fs::create_directories((folder / name).parent_path());
        write_bytes_to(folder / name, document.dump());
    }
    // Writes an array of bytes of version 2, in one chunk, that all have the same value.
    void write_array(const std::string& name, const std::vector<int>& shape, char value = 'x',
                     const json& attributes = json::object()) {
        std::string key;
        std::size_t count = 1;
        for (const int size : shape) {
            key += key.empty() ? "0" : ".0";
            count *= static_cast<std::size_t>(size);
        }
        write(name + "/.zarray", {{"zarr_format", 2},
                                  {"shape", shape},
                                  {"chunks", shape},
                                  {"dtype", "|u1"},
                                  {"order", "C"},
                                  {"fill_value", 0},
                                  {"compressor", nullptr},
                                  {"filters", nullptr}});
        if (!attributes.empty()) write(name + "/.zattrs", attributes);
        write_bytes_to(folder / name / key, std::string(count, value));
    }
    static json axes(const std::vector<std::pair<std::string, std::string>>& named) {
        json list = json::array();
        for (const auto& [name, unit] : named) {
            json axis{{"name", name},
                      {"type", name == "t"   ? "time"
                               : name == "c" ? "channel"
                                             : "space"}};
            if (!unit.empty()) axis["unit"] = unit;
            list.push_back(axis);
        }
        return list;
    }
    static json level(const std::string& path, const json& scale) {
        const json step{{"type", "scale"}, {"scale", scale}};
        return {{"path", path}, {"coordinateTransformations", json::array({step})}};
    }
    Volume open(const std::string& name, const VolumeRequest& request = {}) {
        contents = {};
        return open_volume(folder / name, request, {.contents = &contents});
    }

    TemporaryFolder folder;
    VolumeContents contents;
};

TEST_F(ZarrHierarchies, ListLevelsChannelsTimesAndLabels) {
    write("a.zarr/.zattrs",
          {{"multiscales",
            {{{"axes", axes({{"t", "minute"}, {"c", ""}, {"z", "nm"}, {"y", "nm"}, {"x", "nm"}})},
              {"datasets", {level("0", {2.5, 1, 4, 2, 2}), level("1", {2.5, 1, 4, 4, 4})}}}}},
           {"omero", {{"channels", {{{"label", "DAPI"}}, {{"color", "FF0000"}}}}}}});
    write_array("a.zarr/0", {3, 2, 4, 6, 8});
    write_array("a.zarr/1", {3, 2, 4, 3, 4});
    write("a.zarr/labels/.zattrs", {{"labels", {"cells"}}});
    write("a.zarr/labels/cells/.zattrs", {{"multiscales",
                                           {{{"axes", axes({{"z", ""}, {"y", ""}, {"x", ""}})},
                                             {"datasets", {level("0", {1, 1, 1})}}}}}});
    write_array("a.zarr/labels/cells/0", {4, 6, 8});
    const test::HeardWarnings heard;
    const Volume volume = open("a.zarr");
    EXPECT_EQ(volume.grid().unit, "nm");
    EXPECT_EQ(volume.grid().axes, WorldAxes::named);
    EXPECT_EQ(contents.arrays, (std::vector<std::string>{"", "labels/cells"}));
    EXPECT_EQ(contents.channels, (std::vector<std::string>{"DAPI", ""}));
    EXPECT_EQ(contents.times, (std::vector<std::string>{"0 minute", "2.5 minute", "5 minute"}));
    ASSERT_EQ(contents.levels.size(), 2u);
    EXPECT_EQ(contents.levels[0], (std::array<std::int64_t, 3>{8, 6, 4}));
    EXPECT_EQ(contents.levels[1], (std::array<std::int64_t, 3>{4, 3, 4}));
    for (const char* const what : {"time 0 of 3", "channel 0 of 2", "level 0 of 2"})
        EXPECT_NE(heard.all().find(what), std::string::npos) << heard.all();

    // A level that is named as an array lies where the image has it.
    VolumeRequest request;
    request.array = "1";
    EXPECT_EQ(open("a.zarr", request).grid().step[0].x, 4);
    EXPECT_EQ(open("a.zarr/1").grid().step[0].x, 4);
    const OnlyBelowScope below(folder / "a.zarr/1");
    EXPECT_EQ(open("a.zarr/1").grid().step[0].x, 1);
}

// By which an automatic camera knows that z is up.
TEST_F(ZarrHierarchies, KeepWhetherAxesHaveNames) {
    const test::HeardWarnings heard;
    const auto axes_of_array = [&](const json& attributes) {
        write_array("one.zarr", {3, 4, 5}, 'x', attributes);
        return open("one.zarr").grid().axes;
    };
    EXPECT_EQ(axes_of_array(json::object()), WorldAxes::unnamed);
    EXPECT_EQ(axes_of_array({{"_ARRAY_DIMENSIONS", {"lev", "lat", "lon"}}}), WorldAxes::named);
    EXPECT_EQ(axes_of_array({{"_ARRAY_DIMENSIONS", {"a", "b", "x"}}}), WorldAxes::unnamed);
}

TEST_F(ZarrHierarchies, SayWhichUnitsAreNotBroughtToOne) {
    write("a.zarr/.zattrs",
          {{"multiscales",
            {{{"axes", axes({{"z", "second"}, {"y", "millimeter"}, {"x", "micrometer"}})},
              {"datasets", {level("0", {3, 2, 1})}}}}}});
    write_array("a.zarr/0", {4, 6, 8});
    const test::HeardWarnings heard;
    const Grid grid = open("a.zarr").grid();
    EXPECT_EQ(grid.unit, "micrometer");
    EXPECT_DOUBLE_EQ(grid.step[1].y, 2000);
    EXPECT_EQ(grid.step[2].z, 3);
    EXPECT_NE(heard.all().find("second"), std::string::npos) << heard.all();
}

TEST_F(ZarrHierarchies, TakeUnnamedAxesByOneRule) {
    write_array("channels.zarr", {3, 4, 5, 6});
    write_array("times.zarr", {5, 4, 5, 6});
    const test::HeardWarnings heard;
    open("channels.zarr");
    EXPECT_NE(heard.all().find("the axis of 3 has no name and is taken for channels"),
              std::string::npos);
    open("times.zarr");
    EXPECT_NE(heard.all().find("the axis of 5 has no name and is taken for times"),
              std::string::npos);
    VolumeRequest request;
    request.channel = 4;
    EXPECT_EQ(open("times.zarr", request).grid().size[2], 4);
    EXPECT_EQ(contents.channels.size(), 5u);
}

TEST_F(ZarrHierarchies, AcceptNumbersThatPythonWritesWithoutQuotes) {
    write_array("a.zarr", {4, 5, 6});
    write_bytes_to(folder / "a.zarr/.zattrs",
                   R"({"_FillValue": NaN, "max": Infinity, "least": -Infinity, "\"NaN": "NaN\\"})");
    EXPECT_EQ(open("a.zarr").grid().sample_count(), 4 * 5 * 6);
    write_bytes_to(folder / "a.zarr/.zattrs", R"({"scale_factor": 0})");
    expect_error([&] { open("a.zarr"); }, {"scale_factor", "found 0"});
}

// Outputs may not replace these files, and studies watch them.
TEST_F(ZarrHierarchies, ListFilesThatAnImageNamesElsewhere) {
    write("a.zarr/.zattrs", {{"multiscales",
                              {{{"axes", axes({{"z", ""}, {"y", ""}, {"x", ""}})},
                                {"datasets", {level("../b", {1, 1, 1})}}}}}});
    write_array("b", {4, 6, 8});
    EXPECT_EQ(open("a.zarr").grid().sample_count(), 4 * 6 * 8);
    const std::vector<fs::path> files = files_of_volume(folder / "a.zarr", {});
    const auto has = [&](const fs::path& file) {
        return std::ranges::any_of(files, [&](const fs::path& one) {
            return one.lexically_normal() == (folder / file).lexically_normal();
        });
    };
    for (const char* const file : {"a.zarr/.zattrs", "b/.zarray", "b/0.0.0"})
        EXPECT_TRUE(has(file)) << file;
}

// Links to folders on their own path, and a link to itself, are passed over.
TEST_F(ZarrHierarchies, ComeToAnEndWhereLinksGoRound) {
    write("a.zarr/.zgroup", {{"zarr_format", 2}});
    write_array("a.zarr/inner/0", {4, 6, 8});
    for (int i = 0; i < 30; ++i) {
        fs::create_directory_symlink(".", folder / fmt::format("a.zarr/l{}", i));
        fs::create_directory_symlink("..", folder / fmt::format("a.zarr/inner/l{}", i));
    }
    fs::create_symlink("loop", folder / "a.zarr/loop");
    fs::create_symlink("loop", folder / "a.zarr/inner/0/loop");
    const test::HeardWarnings heard;
    EXPECT_EQ(open("a.zarr").grid().sample_count(), 4 * 6 * 8);
    EXPECT_EQ(contents.arrays, (std::vector<std::string>{"inner/0"}));
    EXPECT_EQ(heard.all(), "");
    EXPECT_EQ(files_of_volume(folder / "a.zarr", {}).size(), 3u);
    EXPECT_EQ(open("a.zarr/inner/0").grid().sample_count(), 4 * 6 * 8);

    // An array that a link names is found under both names.
    fs::create_directory_symlink("inner/0", folder / "a.zarr/other");
    expect_error([&] { open("a.zarr"); }, {"found the arrays inner/0, other, expected one"});
}

// Twenty folders with a link to each of the others make 20! paths.
TEST_F(ZarrHierarchies, LookIntoTenThousandFoldersAndSaySo) {
    write("a.zarr/.zgroup", {{"zarr_format", 2}});
    write_array("a.zarr/0", {4, 6, 8});
    constexpr int count = 20;
    for (int i = 0; i < count; ++i) fs::create_directory(folder / fmt::format("a.zarr/f{}", i));
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            fs::create_directory_symlink(fmt::format("../f{}", j),
                                         folder / fmt::format("a.zarr/f{}/l{}", i, j));
    const test::HeardWarnings heard;
    EXPECT_EQ(open("a.zarr").grid().sample_count(), 4 * 6 * 8);
    EXPECT_EQ(contents.arrays, (std::vector<std::string>{"0"}));
    ASSERT_EQ(heard.texts.size(), 1u) << heard.all();
    EXPECT_NE(heard.all().find("more than 10000 folders"), std::string::npos) << heard.all();
    EXPECT_NE(heard.all().find("the rest is not listed"), std::string::npos) << heard.all();
}

TEST_F(ZarrHierarchies, NameArraysThatAnImagePromisesInVain) {
    write("a.zarr/.zattrs", {{"multiscales",
                              {{{"axes", axes({{"z", ""}, {"y", ""}, {"x", ""}})},
                                {"datasets", {level("0", {1, 1, 1})}}}}}});
    expect_error([&] { open("a.zarr"); }, {"a.zarr/0/.zarray", "no such file"});
    write("a.zarr/0/zarr.json", json::object());
    expect_error([&] { open("a.zarr"); }, {"a.zarr/0/zarr.json", "zarr_format", "found none"});
}

}  // namespace
}  // namespace lamina
