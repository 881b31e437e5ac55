// SPDX-License-Identifier: Apache-2.0
// The targets exr, npy and png: pictures are read as by `lamina compare`, and compared with
// themselves.
#include <variant>

#include "image/picture.h"
#include "runs.h"
#include "scratch_folder.h"
#include "violation.h"

namespace lamina::fuzz {
namespace {

void run_picture(const char* name, std::string_view input) {
    const auto file = scratch_file(name, input);
    may_fail([&] {
        const LoadedImage image = load_image(file);
        const Difference none = difference(image, image);
        for (const double each : none.e) require(each == 0, "a picture differs from itself");
    });
}

}  // namespace

void run_exr(std::string_view input) {
    run_picture("picture.exr", input);
}

void run_npy(std::string_view input) {
    run_picture("picture.npy", input);
}

void run_png(std::string_view input) {
    run_picture("picture.png", input);
}

}  // namespace lamina::fuzz
