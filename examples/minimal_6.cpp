// SPDX-License-Identifier: Apache-2.0
// A session that turns: minimal_6 FILE PREFIX VIEWS writes PREFIX0.png, PREFIX1.png and so on.
#include <lamina/lamina.h>

#include <cstdio>
#include <cstdlib>
#include <string>

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    const int views = std::atoi(argv[3]);
    lamina::Session session(lamina::load_scene(argv[1]));
    const lamina::Camera first = *session.chosen_scene().camera;
    for (int i = 0; i < views; ++i) {
        // The data are read, measured and uploaded once.
        session.set_camera(lamina::turned(first, 360.0 * i / views));
        const std::string file = argv[2] + std::to_string(i) + ".png";
        lamina::save_picture(session.draw(), file, session.scene().background);
        std::printf("%s: %.1f ms\n", file.c_str(), session.statistics().draw_ms);
    }
    for (const std::string& warning : session.take_warnings())
        std::fprintf(stderr, "minimal_6: %s\n", warning.c_str());
}
