// SPDX-License-Identifier: Apache-2.0
// Chooses transfer function and camera from the data if a scene leaves them open.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "annotation/annotation_layer.h"
#include "choice/automatic_transfer.h"
#include "choice/field.h"
#include "choice/opacity_presets.h"
#include "choice/orientation.h"
#include "lamina/camera.h"
#include "lamina/scene.h"
#include "lamina/volume.h"

namespace lamina {

// Returns a perspective camera in whose picture one or more points just fit, with a margin of 1/25
// of half the picture: the one of these axes, turned by `turn`. Its `up` is that of the axes unless
// the view is along it. `all_around`: the points fit after any turn of the camera about its `up`.
// `margins` are left free of the points.
Camera fitted_camera(std::span<const glm::dvec3> points, const Axes& front, const ViewTurn& turn,
                     int width, int height, bool all_around = false, PictureMargins margins = {});

// Moves the camera around its centre. Its `up` stays, so that turntables stand upright, unless the
// view is along it or beyond a pole.
Camera turned(const Camera& camera, const ViewTurn& turn);

// Returns the camera with objects `factor` times as large in the picture.
Camera zoomed(Camera camera, double factor);

// Lights as words (lights_of()). two: a key light from the left and a weaker one from the right.
enum class LightWord { headlight, left, right, two };
const char* name_of(LightWord word);

// Changes that the user wants of a scene, or of what would be chosen for it (choice/words.h).
struct Adjustments {
    TransferAdjustments transfer{};
    std::string map_in_hu{};                // name of the colour map, if the data must be in HU
    std::optional<OpacityCurve> opacity{};  // extinction is then scaled by the automatic density
    std::string opacity_word{};             // for people
    double density = 1;                     // factor on extinction
    ViewTurn turn{};
    std::optional<UpAxis> up{};  // if `up` or `side` is given, the camera is the automatic one
    std::optional<ViewSide> side{};
    double zoom = 1;
    std::optional<LightWord> light{};
    Clip clip{};              // what to cut away beside the scene's own clip (adjust_scene())
    bool own_crop = false;    // nothing is cropped but what `clip` says
    bool all_around = false;  // an automatic camera's picture fits from all sides

    bool transfer_function() const {
        return transfer.colormap || transfer.range || opacity || density != 1;
    }
    bool camera() const {
        return up || side || turn.azimuth != 0 || turn.elevation != 0 || zoom != 1;
    }
    bool any() const { return transfer_function() || camera() || light || !clip.keeps_all(); }
};

// Tells whether transfer function, camera or smallest lit gradient must be chosen from the data.
bool leaves_something_open(const Scene& scene);

// A scene in which everything is chosen, and sentences on what was chosen.
struct Choices {
    Scene scene;
    std::vector<std::string> reasons;
};

// Chooses what the scene leaves open, from data and adjustments alone, and applies the adjustments,
// after those of adjust_scene(). Open colour maps must be closed before. Throws Error if it must
// choose and no value is finite.
Choices choose(Scene asked, const Field& field, const Adjustments& adjustments = {});

// Returns the lines that say what was chosen, the first ones of the explanation of a plan.
std::string chosen_text(const std::vector<std::string>& reasons);

}  // namespace lamina
