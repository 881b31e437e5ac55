// SPDX-License-Identifier: Apache-2.0
// Compares what lamina reads with Zarr arrays, HDF5 files and DICOM slices that zarr, h5py and
// pydicom wrote (array_oracle.py).
#include <sys/wait.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/client.h"
#include "base/json_text.h"
#include "expect_boxes.h"
#include "nrrd_files.h"
#include "support/expect_error.h"
#include "support/heard_warnings.h"
#include "support/temporary_folder.h"
#include "volume_files/volume_file.h"

namespace lamina {
namespace {

VolumeRequest request_of(const nlohmann::json& keys) {
    VolumeRequest request;
    request.array = keys.value("array", "");
    const auto number = [&](const char* key, std::optional<std::int64_t>& to) {
        if (keys.contains(key)) to = keys[key].get<std::int64_t>();
    };
    number("level", request.level);
    number("channel", request.channel);
    number("time", request.time);
    return request;
}

std::vector<double> values_of(const Volume& volume) {
    const auto count = static_cast<std::size_t>(volume.grid().sample_count());
    std::vector<double> values(count);
    const auto copy = [&](const auto* from) { std::copy(from, from + count, values.begin()); };
    switch (volume.type()) {
        case SampleType::uint8:
            copy(static_cast<const std::uint8_t*>(volume.data()));
            break;
        case SampleType::int16:
            copy(static_cast<const std::int16_t*>(volume.data()));
            break;
        case SampleType::uint16:
            copy(static_cast<const std::uint16_t*>(volume.data()));
            break;
        case SampleType::float32:
            copy(static_cast<const float*>(volume.data()));
            break;
    }
    return values;
}

std::vector<double> expected_values(const std::filesystem::path& file) {
    const std::string bytes = read_bytes_of(file);
    std::vector<double> values(bytes.size() / sizeof(double));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

// Compares a grid with the expected one. Steps may be off by some 1e-6 of themselves, because
// headers have 10 digits and coordinates are float32; or by "near", as far as samples are moved.
void expect_place(const Grid& grid, const nlohmann::json& expected) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(grid.size[axis], expected["size"][axis].get<std::int64_t>());
        const int i = static_cast<int>(axis);
        const double near = expected.value("near", 0.0);
        EXPECT_NEAR(grid.origin[i], expected["origin"][axis].get<double>(), 1e-5 + near);
        for (int component = 0; component < 3; ++component) {
            const double step =
                expected["steps"][axis][static_cast<std::size_t>(component)].get<double>();
            if (grid.size[axis] == 1) continue;  // any step will do
            EXPECT_NEAR(grid.step[axis][component], step, 2e-6 * (1 + std::abs(step)) + near);
        }
    }
    if (expected.contains("unit")) {
        EXPECT_EQ(grid.unit, expected["unit"].get<std::string>());
    }
}

// Compares what was said with the words expected; if they are none, nothing was to be said.
void expect_said(const std::string& said, const nlohmann::json& words) {
    for (const auto& word : words)
        EXPECT_NE(said.find(word.get<std::string>()), std::string::npos) << said;
    if (words.empty()) {
        EXPECT_EQ(said, "");
    }
}

// Tells if a volume can stay in its files, and checks that its samples are then those in memory.
bool stays_as_it_is(const Volume& whole, const std::filesystem::path& path,
                    const VolumeRequest& request) {
    std::optional<Volume> by_parts;
    try {
        by_parts.emplace(open_volume(path, request, test::in_files));
    } catch (const Error&) {
        return false;
    }
    test::expect_boxes(whole, *by_parts, 20);
    return true;
}

TEST(ArrayOracle, AgreesWithFilesOfOtherLibraries) {
    int in_files = 0, in_hdf5 = 0;
    const TemporaryFolder folder;
    const std::string script =
        std::string(LAMINA_SOURCE_DIR) + "/tests/volume_files/array_oracle.py";
    const int status =
        std::system(("/usr/bin/python3 '" + script + "' '" + folder.path().string() + "'").c_str());
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "python3-zarr, -h5py or -pydicom is missing";
    ASSERT_EQ(status, 0);
    const std::filesystem::path root = folder.path();
    const nlohmann::json cases = load_json(folder / "cases.json");
    EXPECT_GT(cases.size(), 100u);
    const std::string formats = volume_format_names();
    for (const nlohmann::json& one : cases) {
        const auto name = one["name"].get<std::string>();
        SCOPED_TRACE(name);
        const auto is_of = [&](const char* words) { return name.starts_with(words); };
        const bool hdf5 = is_of("h5_") || is_of("nc");
        if (hdf5 && formats.find("HDF5") == std::string::npos) continue;
        if (is_of("dcm") && formats.find("DICOM") == std::string::npos) continue;
        const auto path = folder / one["path"].get<std::string>();
        const VolumeRequest request = request_of(one["request"]);
        if (one.contains("error")) {
            const std::string message = error_of([&] { read_volume(path, request); });
            for (const auto& word : one["error"])
                EXPECT_NE(message.find(word.get<std::string>()), std::string::npos) << message;
            continue;
        }
        EXPECT_TRUE(is_volume_file(path));
        const OnlyBelowScope below(root);
        std::optional<Volume> volume;
        const test::HeardWarnings heard;
        try {
            volume.emplace(read_volume(path, request));
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
            continue;
        }
        expect_place(volume->grid(), one);
        if (one.contains("says")) expect_said(heard.all(), one["says"]);
        const bool stays = stays_as_it_is(*volume, path, request);
        in_files += stays;
        in_hdf5 += stays && hdf5;
        const std::vector<double> values = values_of(*volume),
                                  expected = expected_values(folder / (name + ".values"));
        ASSERT_EQ(values.size(), expected.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (std::isnan(expected[i]) && std::isnan(values[i])) continue;
            // Values are drawn in float32 at most.
            ASSERT_EQ(values[i], static_cast<double>(static_cast<float>(expected[i]))) << i;
        }
    }
    EXPECT_GT(in_files, 30);
    if (formats.find("HDF5") != std::string::npos) {
        EXPECT_GT(in_hdf5, 8);
    }
}

}  // namespace
}  // namespace lamina
