// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "lamina/volume.h"
#include "plan/frame_renderer.h"
#include "plan/plan.h"

namespace lamina {

// Makes a renderer that draws a volume as the plan says. The capabilities decide whether it is the
// native engine or OpenGL in the current context. The context and the volume must outlive the
// renderer. `before`: a renderer of the same volume and capabilities, or null. Its copy of the
// volume is taken over where it serves.
std::unique_ptr<FrameRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height,
                                                   const FrameRenderer* before = nullptr);

}  // namespace lamina
