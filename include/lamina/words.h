// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "lamina/error.h"

namespace lamina {

// Changes of a picture in the words of the command line (docs/first-picture.md, "Changing it").
// Each member holds the text after the option of its name; one that is empty changes nothing.
struct Words {
    double azimuth = 0, elevation = 0;  // degrees
    double zoom = 1, density = 1;       // factors
    std::string up{}, view{}, light{}, crop{}, opacity{}, preset{}, colormap{}, range{};
    std::vector<std::string> clip{};
};

// Returns the words that a member can hold if it has a list of them, as "up", "view", "light",
// "opacity" and "preset" have; otherwise none.
LAMINA_API std::vector<std::string> known_words(const std::string& member);

// Calls visit(name, member) for each word.
template <typename Given, typename Visit>
void for_each_word(Given& words, const Visit& visit) {
    visit("azimuth", words.azimuth);
    visit("elevation", words.elevation);
    visit("zoom", words.zoom);
    visit("density", words.density);
    visit("up", words.up);
    visit("view", words.view);
    visit("light", words.light);
    visit("crop", words.crop);
    visit("opacity", words.opacity);
    visit("preset", words.preset);
    visit("colormap", words.colormap);
    visit("range", words.range);
    visit("clip", words.clip);
}

}  // namespace lamina
