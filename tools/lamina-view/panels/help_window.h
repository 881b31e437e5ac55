// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::view {

// Shows what pointer and keys do, in a window over everything else. `open` is cleared when it is
// closed.
void help_window(bool& open);

}  // namespace lamina::view
