// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "volume/generator.h"

namespace lamina {

// A turbulent mixing layer after a Richtmyer-Meshkov instability, in looks: light fluid (0) at
// small x, heavy fluid (1) at large x; narrow spikes of heavy fluid reach into the light one and
// broad bubbles of light fluid into the heavy one; in between both are stirred down to a few
// samples, so a finer grid shows finer eddies.
std::unique_ptr<Generator> make_mixing(const GridSize& size);

}  // namespace lamina
