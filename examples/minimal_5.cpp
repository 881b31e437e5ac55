// SPDX-License-Identifier: Apache-2.0
// A truth and an error: minimal_5 FILE says how wrong pictures of a file are, and what they cost.
#include <lamina/lamina.h>

#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    lamina::Session session(lamina::load_scene(argv[1]));
    const lamina::PreciseImage truth = session.trace();  // the reference tracer: takes a while
    std::printf("target     ms     largest error, mean, root mean square, in 1/255\n");
    for (const lamina::Target target :
         {lamina::Target::fixed8, lamina::Target::fixed16, lamina::Target::float32}) {
        lamina::Scene scene = session.scene();
        scene.target = target;
        session.set_scene(scene);
        session.draw();  // chooses and prepares
        const lamina::ErrorNorms error = lamina::error_of(session.draw(), truth);
        std::printf("%-8s %6.1f  %8.3f %8.3f %8.3f\n", lamina::name_of(target),
                    session.statistics().draw_ms, error.linf, error.mean, error.l2);
    }
}
