// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render_job.h"

namespace lamina {

// Says where slicing may exceed the scene's render.max_error, and why.
void say_what_is_not_kept(const RenderRequest& request, const SlicePlan& plan);

}  // namespace lamina
