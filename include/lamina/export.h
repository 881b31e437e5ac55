// SPDX-License-Identifier: Apache-2.0
#pragma once

// What programs outside of the library may use; all else is hidden from them.
#define LAMINA_API __attribute__((visibility("default")))
