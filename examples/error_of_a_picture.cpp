// SPDX-License-Identifier: Apache-2.0
// How wrong a picture is, and what it costs: error_of_a_picture SCENE.json
#include <lamina/lamina.h>

#include <cstdio>

int main(int argc, char** argv) try {
    if (argc < 2) {
        std::fprintf(stderr, "usage: error_of_a_picture SCENE.json\n");
        return 2;
    }
    lamina::Session session(lamina::load_scene(argv[1]));
    const lamina::PreciseImage truth = session.trace();  // the reference tracer: takes a while
    std::printf("target     ms     largest error, root mean square, in 1/255\n");
    for (const lamina::Target target :
         {lamina::Target::fixed8, lamina::Target::fixed16, lamina::Target::float32}) {
        lamina::Scene scene = session.scene();
        scene.target = target;
        session.set_scene(scene);
        session.draw();  // chooses and prepares
        const lamina::Image& picture = session.draw();
        const lamina::ErrorNorms error = lamina::error_of(picture, truth);
        std::printf("%-8s %6.1f  %8.3f %8.3f\n", lamina::name_of(target),
                    session.statistics().draw_ms, error.linf, error.l2);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "error_of_a_picture: %s\n", error.what());
    return 1;
}
