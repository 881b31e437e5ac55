// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::view {

// Shows what pointer and keys do, in a window above all others. Clears `open` when it is closed.
void help_window(bool& open);

}  // namespace lamina::view
