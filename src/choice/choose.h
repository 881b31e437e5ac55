// SPDX-License-Identifier: Apache-2.0
// Chooses transfer function and camera from the data if a scene leaves them open.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "annotation/annotation_layer.h"
#include "choice/automatic_transfer.h"
#include "choice/field.h"
#include "lamina/camera.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Degrees by which a camera moves around its centre: to the right (azimuth) and up (elevation).
struct ViewTurn {
    double azimuth = 0, elevation = 0;
};

// Returns a perspective camera in three-quarter view in whose picture one or more points just fit,
// with a margin of 1/25 of half the picture. In a patient's axes it looks from in front, a little
// from the left and above, the head up; otherwise from +z, a little from +x and +y, with +y up.
// `turn` is added. `all_around`: the points fit after any turn of the camera about its `up`.
// `margins` are left free of the points.
Camera fitted_camera(std::span<const glm::dvec3> points, WorldAxes axes, const ViewTurn& turn,
                     int width, int height, bool all_around = false, PictureMargins margins = {});

// Moves the camera around its centre. Its up vector moves along, so it can cross the poles.
Camera turned(const Camera& camera, const ViewTurn& turn);

// Returns the camera with objects `factor` times as large in the picture.
Camera zoomed(Camera camera, double factor);

// Changes that the user wants of a scene, or of what would be chosen for it.
struct Adjustments {
    TransferAdjustments transfer{};
    double density = 1;  // factor on extinction
    ViewTurn turn{};
    double zoom = 1;
    bool all_around = false;  // an automatic camera's picture fits from all sides

    bool transfer_function() const { return transfer.colormap || transfer.range || density != 1; }
    bool camera() const { return turn.azimuth != 0 || turn.elevation != 0 || zoom != 1; }
};

// Tells whether transfer function, camera or smallest lit gradient must be chosen from the data.
bool leaves_something_open(const Scene& scene);

// A scene in which everything is chosen, and sentences on what was chosen.
struct Choices {
    Scene scene;
    std::vector<std::string> reasons;
};

// Chooses what the scene leaves open, from data and adjustments alone, and applies the adjustments.
// Open colour maps must be closed before. Throws Error if it must choose and no value is finite.
Choices choose(Scene asked, const Field& field, const Adjustments& adjustments = {});

// Returns the lines that say what was chosen, the first ones of the explanation of a plan.
std::string chosen_text(const std::vector<std::string>& reasons);

}  // namespace lamina
