// SPDX-License-Identifier: Apache-2.0
// A mesh: minimal_4 PICTURE.png draws a pyramid of two tetrahedra.
#include <lamina/lamina.h>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    lamina::MeshData mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {.5, .5, 1}};
    mesh.tets = {{0, 1, 2, 4}, {0, 2, 3, 4}};
    mesh.point_scalars = {{"height", {0, 0, 0, 0, 1}}};

    lamina::Scene scene;
    scene.method = lamina::Method::project;
    scene.transfer_function = lamina::TransferFunction::linear({
        {0, {{0.1, 0.3, 1.0}, 1.0}},  // value, colour (linear light), extinction
        {1, {{1.0, 0.7, 0.2}, 6.0}},
    });
    scene.camera = lamina::orbit({{0, 0, 0}, {1, 1, 1}}, 30, 20);
    lamina::Session session(scene, mesh);
    lamina::save_picture(session.draw(), argv[1]);
}
