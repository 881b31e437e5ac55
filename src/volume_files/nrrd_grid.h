// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <teem/nrrd.h>

#include <string>
#include <vector>

#include "lamina/grid.h"
#include "lamina/volume_request.h"
#include "volume_files/stored_data.h"

namespace lamina {

// Returns the grid that a parsed header describes (docs/scene.md, "What is drawn"). `file`: for
// messages. `has_spacings`: the header has a field of that name, which then must give every spacing
// that nothing else gives. Throws Error if the axes are not three, not spatial, not orthogonal, or
// not finite.
Grid nrrd_grid(const std::string& file, const Nrrd& nrrd, bool has_spacings);

// Returns the axes of the data, with the index that is taken of those that do not span the grid:
// the request's time of an axis of that kind, its channel of another. Throws Error if there is no
// such index.
std::vector<StoredAxis> nrrd_axes(const std::string& file, const Nrrd& nrrd,
                                  const VolumeRequest& request);

}  // namespace lamina
