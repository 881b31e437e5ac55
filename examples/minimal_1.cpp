// SPDX-License-Identifier: Apache-2.0
// A file: minimal_1 FILE PICTURE.png draws a volume, a mesh or a scene.
#include <lamina/lamina.h>

#include <cstdio>

int main(int argc, char** argv) try {
    if (argc != 3) return std::fprintf(stderr, "usage: minimal_1 FILE PICTURE.png\n"), 2;
    lamina::Session session(lamina::load_scene(argv[1]));  // what a scene leaves open is chosen
    lamina::save_picture(session.draw(), argv[2], session.scene().background);
} catch (const lamina::Error& error) {
    std::fprintf(stderr, "minimal_1: %s\n", error.what());
    return 1;
}
