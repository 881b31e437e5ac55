// SPDX-License-Identifier: Apache-2.0
// A scene turned right round, one PNG file a view: turntable SCENE.json FOLDER [VIEWS]
#include <lamina/lamina.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

int main(int argc, char** argv) try {
    if (argc < 3) {
        std::fprintf(stderr, "usage: turntable SCENE.json FOLDER [VIEWS]\n");
        return 2;
    }
    const std::filesystem::path folder = argv[2];
    const int views = argc > 3 ? std::max(1, std::atoi(argv[3])) : 36;
    std::filesystem::create_directories(folder);

    lamina::Session session(lamina::load_scene(argv[1]));
    const lamina::Camera first = *session.chosen_scene().camera;
    for (int i = 0; i < views; ++i) {
        // The data are read, measured and uploaded once.
        session.set_camera(lamina::turned(first, 360.0 * i / views));
        const lamina::Image& picture = session.draw();
        lamina::save_picture(picture, folder / (std::to_string(1000 + i).substr(1) + ".png"),
                             session.scene().background, session.scene().color_space);
        std::printf("view %d: %.1f ms\n", i, session.statistics().draw_ms);
    }
    for (const std::string& warning : session.take_warnings())
        std::fprintf(stderr, "turntable: %s\n", warning.c_str());
} catch (const std::exception& error) {
    std::fprintf(stderr, "turntable: %s\n", error.what());
    return 1;
}
