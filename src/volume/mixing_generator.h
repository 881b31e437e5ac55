// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/generator.h"

namespace lamina {

// A field that looks like a turbulent mixing layer after a Richtmyer-Meshkov instability. Light
// fluid (0) lies at small x, heavy fluid (1) at large x. Narrow spikes of heavy fluid reach into
// the light one, and broad bubbles of light fluid into the heavy one. In between both are mixed
// down to the scale of a few samples, so that a finer grid shows finer eddies.
std::unique_ptr<Generator> make_mixing(const GridSize& size);

}  // namespace lamina
