// SPDX-License-Identifier: Apache-2.0
// Words for what people change of a picture: the one reading of them for the command line, Python
// and the viewer.
#pragma once

#include <string>

#include "base/error.h"
#include "choice/choose.h"
#include "lamina/image.h"
#include "lamina/scene.h"
#include "lamina/words.h"

namespace lamina {

// A mistake in a word. The message begins with the option's name: "up w: expected ...".
class WordError : public Error {
  public:
    using Error::Error;
};

// Returns the changes that words stand for. Reads the file of `colormap`, if it names one. Throws
// WordError, and Error if that file is damaged. `space`: of the scene's colours.
Adjustments adjustments_of(const Words& words, ImageColorSpace space);

// Makes the changes that need no data: adds planes and box of the clip, and lights, whose
// directions choose() sets. Doing it twice changes nothing more. Throws Error for too many planes.
void adjust_scene(Scene& scene, const Adjustments& adjustments);

// Returns the lights of a word for this camera. `two`: one from the left, and a weaker one from the
// right that fills its shadows.
std::vector<Light> lights_of(LightWord word, const Camera& camera);

}  // namespace lamina
