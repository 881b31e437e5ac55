// SPDX-License-Identifier: Apache-2.0
// Chooses transfer function and camera from the data if a scene leaves them open.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "choice/automatic_transfer.h"
#include "choice/field.h"
#include "lamina/camera.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Degrees by which a camera goes around its centre: to the right, and up.
struct ViewTurn {
    double azimuth = 0, elevation = 0;
};

// Returns a perspective camera in three-quarter view that fits one or more points: two opposite
// edges of a margin of 1/25 of the picture are touched. In a patient's axes it looks from in front
// and a little from the left and above, the head up; otherwise from +z, a little from +x and +y,
// with +y up. `turn` is added. `all_around`: they fit, too, if the camera turns about its `up`.
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height, bool all_around = false);

// Returns the camera moved around its centre, its up vector with it: it can cross the poles.
Camera turned(const Camera& camera, const ViewTurn& turn);

// Returns the camera with objects `factor` times as large in the picture.
Camera zoomed(Camera camera, double factor);

// Changes that the user wants to the scene, or to what would be chosen.
struct Wishes {
    TransferWishes transfer{};
    double density = 1;  // factor on extinction
    ViewTurn turn{};
    double zoom = 1;
    bool all_around = false;  // an automatic camera fits all views around its axis

    bool transfer_function() const { return transfer.colormap || transfer.range || density != 1; }
    bool camera() const { return turn.azimuth != 0 || turn.elevation != 0 || zoom != 1; }
};

// Tells whether the data decide on transfer function, camera or the smallest lit gradient.
bool leaves_something_open(const Scene& scene);

// A scene in which nothing is left open, and sentences on what was chosen.
struct Choices {
    Scene scene;
    std::vector<std::string> reasons;
};

// Chooses transfer function, camera and the smallest lit gradient if the scene leaves them open (an
// open colour map must be closed before), and applies the wishes. The result depends on data and
// wishes alone. Throws Error if there is something to choose and the field has no finite value.
Choices choose(Scene asked, const Field& field, const Wishes& wishes = {});

// Returns the first lines of an explanation of the plan, which say what was chosen.
std::string chosen_text(const std::vector<std::string>& reasons);

}  // namespace lamina
