// SPDX-License-Identifier: Apache-2.0
// A volume in memory to a PNG file: render_array [FILE.png]
#include <lamina/lamina.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) try {
    constexpr int n = 64;
    auto samples = std::make_shared<std::vector<float>>();
    for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x)
                samples->push_back(std::sin(.2f * x) + std::sin(.2f * y) + std::sin(.2f * z));
        }
    }
    lamina::Grid grid;
    grid.size = {n, n, n};
    // No copy: the volume shares the array.
    lamina::Volume volume(grid, lamina::SampleType::float32, {samples, samples->data()});

    lamina::Scene scene;
    scene.transfer_function = lamina::TransferFunction::linear({
        {1.0, {{0.1, 0.3, 1.0}, 0.0}},  // value, colour (linear light), extinction
        {2.0, {{0.1, 0.3, 1.0}, 0.3}},
        {3.0, {{1.0, 0.8, 0.2}, 2.0}},
    });
    scene.camera = lamina::orbit(grid.bounds(), 30, 20);  // degrees: azimuth, elevation
    scene.width = 800;
    scene.height = 600;

    lamina::Session session(scene, volume);  // as many slabs as keep the error below 1 / 255
    lamina::save_picture(session.draw(), argc > 1 ? argv[1] : "array.png", scene.background);
} catch (const lamina::Error& error) {
    std::fprintf(stderr, "render_array: %s\n", error.what());
    return 1;
}
