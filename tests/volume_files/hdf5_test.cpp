// SPDX-License-Identifier: Apache-2.0
// Compares what lamina reads with HDF5 and NetCDF files as other programs write them, made by h5py
// and SciPy (oracles/hdf5_files.py): values, places, units, contents, linked files and errors.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/client.h"
#include "expect_boxes.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

VolumeRequest asked(const Json& json) {
    VolumeRequest request;
    request.array = json.value("array", "");
    for (const auto& [key, to] : {std::pair{"channel", &request.channel},
                                  {"time", &request.time},
                                  {"level", &request.level}})
        if (json.contains(key)) *to = json[key].get<std::int64_t>();
    return request;
}

class FilesOfHdf5 : public ::testing::Test {
  protected:
    void SetUp() override {
        if (volume_format_names().find("HDF5") == std::string::npos)
            GTEST_SKIP() << "built without HDF5";
        const int status = std::system(
            fmt::format("/usr/bin/python3 '{}/tests/volume_files/reader_oracles.py' '{}' hdf5",
                        LAMINA_SOURCE_DIR, folder_.path().string())
                .c_str());
        if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "h5py or SciPy is not installed";
        ASSERT_EQ(status, 0);
        std::ifstream stream(folder_ / "cases.json");
        cases_ = Json::parse(stream);
    }

    static void expect_grid(const Json& one, const Grid& grid) {
        EXPECT_EQ(Json(grid.size), one["size"]);
        EXPECT_EQ(grid.unit, one["unit"].get<std::string>());
        EXPECT_EQ(grid.axes == WorldAxes::left_posterior_superior, one["lps"] == true);
        // Coordinates are float32, up to 50: 1e-5 is more than they are rounded by.
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_NEAR(grid.origin[static_cast<int>(i)], one["origin"][i].get<double>(), 1e-5);
            for (std::size_t j = 0; j < 3 && grid.size[i] > 1; ++j)
                EXPECT_NEAR(grid.step[i][static_cast<int>(j)], one["steps"][i][j].get<double>(),
                            1e-5);
            const bool cell = one["cell"].get<bool>() || grid.size[i] == 1;
            EXPECT_EQ(grid.centering[i], cell ? Centering::cell : Centering::node);
        }
    }

    void expect_values(const Json& one, const Volume& volume) const {
        std::vector<double> expected(static_cast<std::size_t>(volume.grid().sample_count()));
        std::ifstream stream(folder_ / one["values"].get<std::string>(), std::ios::binary);
        stream.read(reinterpret_cast<char*>(expected.data()),
                    static_cast<std::streamsize>(expected.size() * sizeof(double)));
        ASSERT_TRUE(stream.good());
        volume.visit([&](const auto* samples) {
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const auto found = static_cast<double>(samples[i]);
                if (std::isnan(found) && std::isnan(expected[i])) continue;
                ASSERT_EQ(found, expected[i]) << "sample " << i;
            }
        });
    }

    static void expect_contents(const Json& expected, const VolumeContents& found) {
        const Json all{{"arrays", found.arrays},
                       {"channels", found.channels},
                       {"times", found.times},
                       {"levels", found.levels},
                       {"is_colour", found.is_colour}};
        for (const auto& [key, value] : expected.items()) EXPECT_EQ(all[key], value) << key;
    }

    void expect_volume(const Json& one) {
        const auto path = folder_ / one["file"].get<std::string>();
        const VolumeRequest request = asked(one["request"]);
        VolumeContents contents;
        VolumeUse use;
        use.contents = &contents;
        heard_.texts.clear();
        const Volume volume = open_volume(path, request, use);
        EXPECT_EQ(name_of(volume.type()), one["type"].get<std::string>());
        expect_grid(one, volume.grid());
        expect_values(one, volume);
        expect_contents(one["contents"], contents);
        for (const Json& part : one["warnings"]) {
            EXPECT_TRUE(std::ranges::any_of(heard_.texts,
                                            [&](const std::string& text) {
                                                return text.find(part.get<std::string>()) !=
                                                       std::string::npos;
                                            }))
                << "nothing says " << part << ", but " << Json(heard_.texts);
        }
        try {
            test::expect_boxes(volume, open_volume(path, request, test::in_files), 20);
            ++in_files_;
        } catch (const Error&) {  // scaled ones, and others, do not stay in their files
        }
    }

    const TemporaryFolder folder_;
    Json cases_;
    int in_files_ = 0;
    test::HeardWarnings heard_;
};

TEST_F(FilesOfHdf5, AreReadAsTheirProgramsMeanThem) {
    const OnlyBelowScope below(folder_.path());
    for (const Json& one : cases_) {
        SCOPED_TRACE(one["file"].get<std::string>() + " " + one["request"].dump());
        if (one.contains("error")) {
            const std::string message = error_of([&] {
                read_volume(folder_ / one["file"].get<std::string>(), asked(one["request"]));
            });
            for (const Json& word : one["error"])
                EXPECT_NE(message.find(word.get<std::string>()), std::string::npos) << message;
            continue;
        }
        try {
            expect_volume(one);
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
    EXPECT_GT(cases_.size(), 120u);
    EXPECT_GT(in_files_, 60);
}

TEST_F(FilesOfHdf5, CountAsReadWithAllThatTheyLeadTo) {
    int found = 0;
    for (const Json& one : cases_) {
        if (!one.contains("files")) continue;
        ++found;
        const auto file = one["file"].get<std::string>();
        std::vector<std::filesystem::path> files = files_of_volume(folder_ / file, {});
        for (auto& path : files) path = std::filesystem::canonical(path);
        for (const Json& name : one["files"]) {
            const auto path = std::filesystem::canonical(folder_ / name.get<std::string>());
            EXPECT_NE(std::ranges::find(files, path), files.end()) << file << " leads to " << name;
        }
    }
    EXPECT_GT(found, 3);
}

// 4 x 5 x 6 shorts become floats: 480 bytes. Beside them a slice, or the whole of a file whose z is
// not the slowest, lies in memory in the file's order and in that of the volume.
TEST_F(FilesOfHdf5, TakeNoMoreMemoryThanTheLimitIfTheyAreClassicNetcdf) {
    VolumeUse use;
    use.residence = VolumeUse::Residence::as_fits;
    for (const auto& [name, bytes] : {std::pair{"order_zyx0.nc", 480 + 2 * 2 * 30},
                                      {"order_zyx1.nc", 480 + 2 * 2 * 30},
                                      {"order_xyz0.nc", 480 + 2 * 2 * 120}}) {
        set_memory_limit(static_cast<std::uint64_t>(bytes));
        EXPECT_EQ(open_volume(folder_ / name, {}, use).type(), SampleType::float32);
        set_memory_limit(static_cast<std::uint64_t>(bytes - 1));
        expect_error([&, file = folder_ / name] { open_volume(file, {}, use); },
                     {name, fmt::format("all {} bytes", bytes), fmt::format("of {}", bytes - 1)});
    }
    set_memory_limit(0);
}

TEST_F(FilesOfHdf5, LeadToNoFileThatIsNotAllowed) {
    const OnlyBelowScope below(folder_ / "parts");
    for (const char* const name : {"outer.h5:/v", "outer.h5:/group/v", "up_scale.h5:/v"}) {
        const std::string message =
            error_of([&] { read_volume(folder_ / "parts" / name, VolumeRequest{}); });
        EXPECT_NE(message.find("not opened: it is not below"), std::string::npos) << message;
    }
    EXPECT_EQ(files_of_volume(folder_ / "parts/outer.h5", {}).size(), 3u);
}

}  // namespace
}  // namespace lamina
