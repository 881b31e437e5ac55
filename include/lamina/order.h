// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina {

// In which samples of a ray are composited; the first sample is nearest the eye.
enum class Order { back_to_front, front_to_back };

}  // namespace lamina
