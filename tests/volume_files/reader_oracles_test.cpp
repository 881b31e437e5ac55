// SPDX-License-Identifier: Apache-2.0
// Compares what lamina reads with what NumPy, nibabel, tifffile and VTK wrote and say about it:
// sizes, places, types and values.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

using Json = nlohmann::json;

glm::dvec3 vector_of(const Json& json) {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

VolumeRequest oracle_request(const Json& json) {
    VolumeRequest request;
    if (json.contains("array")) request.array = json["array"];
    if (json.contains("channel")) request.channel = json["channel"];
    if (json.contains("time")) request.time = json["time"];
    if (json.contains("spacing")) request.spacing = vector_of(json["spacing"]);
    if (json.contains("where")) request.origin = vector_of(json["where"]);
    if (json.contains("raw")) {
        const Json& raw = json["raw"];
        request.raw = RawLayout{{raw[0], raw[1], raw[2]}, raw[3], raw[4], raw[5]};
    }
    return request;
}

std::vector<double> values_of(const std::filesystem::path& path) {
    std::vector<double> values(std::filesystem::file_size(path) / sizeof(double));
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(values.data()),
                static_cast<std::streamsize>(values.size() * sizeof(double)));
    return values;
}

class ReaderOracles : public ::testing::TestWithParam<const char*> {
  protected:
    void expect_grid(const Json& one, const Grid& grid) {
        EXPECT_EQ(Json(grid.size), one["size"]);
        if (one["lps"].is_boolean()) {
            EXPECT_EQ(grid.axes == WorldAxes::left_posterior_superior, one["lps"]);
        }
        if (one["unit"].is_string()) {
            EXPECT_EQ(grid.unit, one["unit"]);
        }
        // Headers hold places in float32 or as text of 6 or more digits. Tolerances are 1e-6 of the
        // largest coordinate, 40, and of the longest step, 3.
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const glm::dvec3 step = vector_of(one["steps"][axis]);
            const double origin = one["origin"][axis];
            EXPECT_NEAR(grid.origin[static_cast<int>(axis)], origin, 4e-5);
            for (int i = 0; i < 3; ++i) EXPECT_NEAR(grid.step[axis][i], step[i], 3e-6);
            const bool cell = one["cell"].get<bool>() || grid.size[axis] == 1;
            EXPECT_EQ(grid.centering[axis], cell ? Centering::cell : Centering::node);
        }
    }

    void expect_values(const std::vector<double>& expected, const Volume& volume) {
        ASSERT_EQ(static_cast<std::size_t>(volume.grid().sample_count()), expected.size());
        std::size_t wrong = 0;
        volume.visit([&](const auto* samples) {
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const auto found = static_cast<double>(samples[i]);
                const auto drawn = static_cast<double>(
                    static_cast<std::remove_cvref_t<decltype(*samples)>>(expected[i]));
                const bool same = found == drawn || (std::isnan(found) && std::isnan(drawn));
                if (!same && wrong++ == 0)
                    ADD_FAILURE() << "sample " << i << " is " << found << ", expected " << drawn;
            }
        });
        EXPECT_EQ(wrong, 0u);
    }

    void expect_warnings(const Json& expected) {
        for (const Json& part : expected) {
            const bool found = std::ranges::any_of(warnings_, [&](const std::string& text) {
                return text.find(part.get<std::string>()) != std::string::npos;
            });
            EXPECT_TRUE(found) << "nothing says " << part;
        }
    }

    test::HeardWarnings heard_;
    std::vector<std::string>& warnings_ = heard_.texts;
};

TEST_P(ReaderOracles, AgreeWithWhatIsRead) {
    const TemporaryFolder folder;
    const std::string script =
        std::string(LAMINA_SOURCE_DIR) + "/tests/volume_files/reader_oracles.py";
    const int status = std::system(
        fmt::format("/usr/bin/python3 '{}' '{}' {}", script, folder.path().string(), GetParam())
            .c_str());
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << GetParam() << " is not installed";
    ASSERT_EQ(status, 0);
    std::ifstream stream(folder / "cases.json");
    const Json cases = Json::parse(stream);
    EXPECT_GT(cases.size(), 50u);
    for (const Json& one : cases) {
        SCOPED_TRACE(one["file"].get<std::string>() + " " + one["request"].dump());
        warnings_.clear();
        if (one.contains("error")) {
            const std::string message = lamina::error_of([&] {
                read_volume(folder / one["file"].get<std::string>(),
                            oracle_request(one["request"]));
            });
            for (const Json& word : one["error"])
                EXPECT_NE(message.find(word.get<std::string>()), std::string::npos) << message;
            continue;
        }
        try {
            const Volume volume = read_volume(folder / one["file"].get<std::string>(),
                                              oracle_request(one["request"]));
            EXPECT_EQ(name_of(volume.type()), one["type"].get<std::string>());
            expect_grid(one, volume.grid());
            expect_values(values_of(folder / one["values"].get<std::string>()), volume);
            expect_warnings(one["warnings"]);
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, ReaderOracles,
                         ::testing::Values("numpy", "nibabel", "tifffile", "vtk"),
                         [](const auto& tool) { return std::string(tool.param); });

}  // namespace
}  // namespace lamina
