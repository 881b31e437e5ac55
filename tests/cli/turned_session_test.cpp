// SPDX-License-Identifier: Apache-2.0
// A session of the library that is turned all around while it changes, compared bit for bit with
// `lamina render` of each resolved scene.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/blobs_scene.h"
#include "cli/lamina_run.h"
#include "image/exr.h"
#include "lamina/session.h"
#include "scene_files/scene_reader.h"
#include "support/temporary_folder.h"
#include "support/transfer_functions.h"

namespace lamina {
namespace {

using test::knot;

// Changes transfer function, target or method, in turn; called for every sixth view.
void change(Session& session, int number) {
    Scene scene = session.scene();
    switch (number % 4) {
        case 0:
            session.set_transfer_function(TransferFunction::linear(
                {knot(20, {1, .2, 0}, 0), knot(90. + number, {1, 1, 0}, 1. + number),
                 knot(255, {0, .3, 1}, 2)}));
            return;
        case 1:
            scene.target = number % 8 == 1 ? Target::fixed8 : Target::fixed16;
            break;
        case 2:
            scene.method = scene.method == Method::slice ? Method::project : Method::slice;
            break;
        case 3:
            scene.target = Target::float32;
            if (number % 8 == 3) scene.target = automatic;
            break;
    }
    session.set_scene(scene);
}

TEST(TurnedSession, DrawsWhatTheProgramDraws) {
    const TemporaryFolder folder;
    nlohmann::json document = gaussians_scene(12, 32, 24, 20);
    document["mesh"] = {{"kuhn", true}};
    document["render"]["slice"]["samples"] = "auto";
    const Scene scene = read_scene(document, folder / "scene.json");
    Session session(scene, {ContextChoice::cpu, 0});
    const Camera first = *scene.camera;
    for (int view = 0; view < 120; ++view) {
        if (view % 6 == 5) change(session, view / 6);
        session.set_camera(turned(first, 3 * view));
        const Image& drawn = session.draw();
        session.save_resolved_scene(folder / "resolved.json");
        const ProgramResult result = lamina_run(
            {"render", folder / "resolved.json", "-o", folder / "fresh.exr", "--context", "cpu"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        ASSERT_EQ(drawn.rgba, read_exr(folder / "fresh.exr").rgba) << "view " << view;
    }
}

}  // namespace
}  // namespace lamina
