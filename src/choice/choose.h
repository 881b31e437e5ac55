// SPDX-License-Identifier: Apache-2.0
// Chooses transfer function and camera from the data if a scene leaves them open.
#pragma once

#include <string>
#include <vector>

#include "choice/automatic_camera.h"
#include "choice/automatic_transfer.h"
#include "choice/field.h"
#include "lamina/scene.h"

namespace lamina {

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

// Tells whether the data decide on something in the scene: its transfer function, its camera or the
// smallest gradient that is lit.
bool leaves_something_open(const Scene& scene);

// A scene in which everything that depends on the data has been chosen, and sentences that say what
// was chosen.
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
