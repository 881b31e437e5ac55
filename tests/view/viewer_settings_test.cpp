// SPDX-License-Identifier: Apache-2.0
#include "model/viewer_settings.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "lamina/error.h"
#include "support/temporary_folder.h"

namespace lamina::view {
namespace {

TEST(ViewerSettings, AreLoadedAsTheyWereSaved) {
    const TemporaryFolder folder;
    const auto file = folder / "new" / "lamina" / "viewer.json";
    ViewerSettings settings;
    settings.trace = false;
    for (int i = 0; i < 12; ++i) settings.add_recent("/data/" + std::to_string(i) + ".nrrd");
    settings.add_recent("/data/5.nrrd");
    settings.save(file);
    const ViewerSettings loaded = ViewerSettings::load(file);
    EXPECT_EQ(loaded.recent, settings.recent);
    EXPECT_EQ(loaded.recent.size(), 10u);
    EXPECT_EQ(loaded.recent[0], "/data/5.nrrd");
    EXPECT_EQ(loaded.recent[1], "/data/11.nrrd");
    EXPECT_FALSE(loaded.trace);
    EXPECT_TRUE(loaded.coarse);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(file.parent_path()), {}), 1);
}

TEST(ViewerSettings, AreDefaultsWithoutAFile) {
    const TemporaryFolder folder;
    EXPECT_TRUE(ViewerSettings::load(folder / "none.json").recent.empty());
    std::ofstream(folder / "bad.json") << "{\"trace\": 7}";
    try {
        ViewerSettings::load(folder / "bad.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("bad.json: not the viewer's settings"),
                  std::string::npos);
    }
}

TEST(ViewerSettings, LieInTheUsersConfigurationFolder) {
    setenv("XDG_CONFIG_HOME", "/somewhere", 1);
    EXPECT_EQ(ViewerSettings::file(), "/somewhere/lamina/viewer.json");
    setenv("XDG_CONFIG_HOME", "relative", 1);
    setenv("HOME", "/home/a", 1);
    EXPECT_EQ(ViewerSettings::file(), "/home/a/.config/lamina/viewer.json");
    unsetenv("XDG_CONFIG_HOME");
    EXPECT_EQ(ViewerSettings::file(), "/home/a/.config/lamina/viewer.json");
}

}  // namespace
}  // namespace lamina::view
