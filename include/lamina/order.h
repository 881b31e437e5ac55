// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// Order in which samples of a ray are composited. The first sample is the nearest to the eye.
enum class Order { back_to_front, front_to_back };

}  // namespace lamina
