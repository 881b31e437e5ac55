// SPDX-License-Identifier: Apache-2.0
#pragma once

// Marks what programs outside the library may use. All other symbols are hidden from them.
#define LAMINA_API __attribute__((visibility("default")))
