// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "choice/choose.h"

namespace lamina {

// Options that change the look of a picture without JSON.
struct ViewOptions {
    ViewTurn turn;
    double zoom = 1, density = 1;
    std::string size, colormap, range, background;
};

void add_view_options(CLI::App& verb, ViewOptions& options);

// Returns the changes that the options make to the scene. Reads the file of --colormap, if that is
// given. Throws UsageError.
Wishes wishes_of(const ViewOptions& options, ImageColorSpace space);

// Returns the other options as values of --set: "image.width=800".
std::vector<std::string> settings_of(const ViewOptions& options);

}  // namespace lamina
