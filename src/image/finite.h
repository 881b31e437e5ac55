// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "lamina/image.h"

namespace lamina {

// Throws Error, which names pixel and channel, where a component is NaN, infinite or beyond the
// range of float32. Such pictures are neither written nor compared. `name`: the beginning of the
// message.
template <typename Real>
void require_finite(const std::string& name, const RgbaImage<Real>& image);

extern template void require_finite(const std::string&, const Image&);
extern template void require_finite(const std::string&, const PreciseImage&);

}  // namespace lamina
