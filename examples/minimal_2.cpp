// SPDX-License-Identifier: Apache-2.0
// An array: minimal_2 PICTURE.png draws samples in memory.
#include <lamina/lamina.h>

#include <cmath>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    constexpr int n = 64;
    auto samples = std::make_shared<std::vector<float>>();
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)  // x changes fastest
                samples->push_back(std::sin(.2f * x) + std::sin(.2f * y) + std::sin(.2f * z));
    lamina::Grid grid;  // samples 1 apart, and a box that spans them
    grid.size = {n, n, n};
    // The volume shares the array and keeps it alive: nothing is copied.
    const lamina::Volume volume(grid, lamina::SampleType::float32, {samples, samples->data()});

    lamina::Scene scene;
    scene.transfer_function = lamina::automatic;  // chosen from the data
    scene.camera = lamina::automatic;
    lamina::Session session(scene, volume);
    lamina::save_picture(session.draw(), argv[1]);
}
