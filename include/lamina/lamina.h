// SPDX-License-Identifier: Apache-2.0
// Includes all public headers: scenes, sessions that draw them, pictures and their errors.
#pragma once

#include "lamina/annotations.h"
#include "lamina/camera.h"
#include "lamina/color.h"
#include "lamina/error.h"
#include "lamina/film.h"
#include "lamina/image.h"
#include "lamina/info.h"
#include "lamina/mesh.h"
#include "lamina/report.h"
#include "lamina/sampling.h"
#include "lamina/scene.h"
#include "lamina/session.h"
#include "lamina/settings.h"
#include "lamina/study.h"
#include "lamina/transfer_function.h"
#include "lamina/volume.h"
#include "lamina/words.h"
