// SPDX-License-Identifier: Apache-2.0
// A transfer function: minimal_3 VOLUME PICTURE.png shows two ranges of values in two colours.
#include <lamina/lamina.h>

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const lamina::Volume volume = lamina::load_volume(argv[1]);
    lamina::Scene scene;
    // Each point has a value, a colour (linear light), and an extinction: the share of light that
    // is held back per unit of length, for short lengths. Between points both are linear.
    scene.transfer_function = lamina::TransferFunction::linear({
        {60, {{0.1, 0.3, 1.0}, 0.0}},
        {120, {{0.1, 0.3, 1.0}, 0.4}},
        {180, {{1.0, 0.7, 0.2}, 0.0}},
        {255, {{1.0, 0.7, 0.2}, 9.0}},
    });
    scene.camera = lamina::orbit(volume.grid().bounds(), 30, 20);  // azimuth, elevation in degrees
    scene.width = 400;
    scene.height = 300;
    lamina::Session session(scene, volume);
    lamina::save_picture(session.draw(), argv[2]);
}
