// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "lamina/volume.h"
#include "plan/frame_renderer.h"
#include "plan/plan.h"

namespace lamina {

// Draws a volume as the plan says with what the capabilities are of: the native engine, or the
// current OpenGL context, which must outlive it, as must the volume.
// `before`: one of the same volume and capabilities, whose copy of the volume is taken over where
// it serves, or null.
std::unique_ptr<FrameRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height,
                                                   const FrameRenderer* before = nullptr);

}  // namespace lamina
