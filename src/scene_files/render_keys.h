// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lamina/scene.h"
#include "scene_files/keys.h"

namespace lamina {

// The keys of "render": how the picture is made. Reading them needs the data's keys before.
const KeyTable<Scene>& render_keys();

// The form of a compositing tree ("$defs/tree"), and of one of its factors.
KeyJson tree_schema();
KeyJson factor_schema();

}  // namespace lamina
