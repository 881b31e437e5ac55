// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "lamina/volume.h"
#include "plan/frame_renderer.h"
#include "plan/plan.h"

namespace lamina {

class TileVolume;
class VolumeTextures;

// The volume as renderers need it: the next renderer takes it over if it serves.
struct SliceParts {
    std::shared_ptr<const TileVolume> tiles;         // of the engine `cpu`
    std::shared_ptr<const VolumeTextures> textures;  // of OpenGL
};

class SliceRenderer : public FrameRenderer {
  public:
    virtual SliceParts parts() const = 0;
};

// Makes a renderer that draws a volume as the plan says. The capabilities decide whether it is the
// engine `cpu` or OpenGL in the current context. The context and the volume must outlive the
// renderer. `ready`: parts of a renderer of the same volume and capabilities, or none.
std::unique_ptr<SliceRenderer> make_slice_renderer(const Volume& volume,
                                                   const TransferFunction& transfer_function,
                                                   const Facts& facts, const SlicePlan& plan,
                                                   const Capabilities& capabilities, int width,
                                                   int height, const SliceParts& ready = {});

}  // namespace lamina
