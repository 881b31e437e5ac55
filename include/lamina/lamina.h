// SPDX-License-Identifier: Apache-2.0
// Everything: a scene, a session that draws it, pictures and their errors.
#pragma once

#include "lamina/camera.h"
#include "lamina/clip.h"
#include "lamina/color.h"
#include "lamina/context_choice.h"
#include "lamina/error.h"
#include "lamina/error_norms.h"
#include "lamina/frame_statistics.h"
#include "lamina/image.h"
#include "lamina/lighting.h"
#include "lamina/mesh_data.h"
#include "lamina/picture_file.h"
#include "lamina/plan_summary.h"
#include "lamina/scene.h"
#include "lamina/session.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
