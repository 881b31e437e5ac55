// SPDX-License-Identifier: Apache-2.0
#include "model/scene_changes.h"

#include "model/scene_edit.h"

namespace lamina::view {
namespace {

using Json = nlohmann::ordered_json;

bool same_camera(const Camera& a, const Camera& b) {
    return a.projection == b.projection && a.eye == b.eye && a.center == b.center && a.up == b.up &&
           a.fov_y == b.fov_y && a.height == b.height;
}

// Only a session that is begun again reads other data.
bool same_data(const Json& a, const Json& b) {
    for (const char* key : {"volume", "scalar", "nan"})
        if (setting_at(a, key) != setting_at(b, key)) return false;
    const Json mesh_a = setting_at(a, "mesh"), mesh_b = setting_at(b, "mesh");
    return mesh_a == mesh_b || (mesh_a.is_object() && mesh_b.is_object());
}

Json without_counted_parts(Json settings) {
    for (const char* key : {"camera", "clip"}) settings.erase(key);
    settings["image"].erase("width");
    settings["image"].erase("height");
    return settings;
}

}  // namespace

void count_changes(const Scene& before, const Scene& after, Revisions& revisions) {
    const Json from = settings_of(before), to = settings_of(after);
    if (!same_data(from, to)) ++revisions.data;
    if (without_counted_parts(from) != without_counted_parts(to) ||
        before.camera.is_automatic() != after.camera.is_automatic() ||
        before.transfer_function.is_automatic() != after.transfer_function.is_automatic())
        ++revisions.settings;
    if (before.transfer_function != after.transfer_function) ++revisions.transfer_function;
    if (before.clip != after.clip) ++revisions.clip;
    if (before.camera.is_given() && after.camera.is_given() &&
        !same_camera(*before.camera, *after.camera))
        ++revisions.camera;
    if (before.width != after.width || before.height != after.height) ++revisions.size;
}

}  // namespace lamina::view
