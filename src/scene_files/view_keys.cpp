// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "image/image_limits.h"
#include "scene/scene.h"
#include "scene_files/keys.h"
#include "scene_files/scene_keys.h"

namespace lamina {
namespace {

bool is_place(const glm::dvec3& v) {
    return std::abs(v.x) <= largest_scene_coordinate && std::abs(v.y) <= largest_scene_coordinate &&
           std::abs(v.z) <= largest_scene_coordinate;
}

void check_camera(JsonReader& reader, const Camera& camera) {
    const std::pair<const char*, const glm::dvec3*> vectors[] = {
        {"eye", &camera.eye}, {"center", &camera.center}, {"up", &camera.up}};
    for (const auto& [key, vector] : vectors)
        if (!is_place(*vector)) reader.reject(key, "coordinates up to 1e100");
    if (camera.height > largest_scene_coordinate)
        reader.reject("height", "at most 1e100 world units");
}

// Adds the key "camera". A camera that is left out is automatic.
void add_camera(KeyTable<Scene>& scene) {
    scene.check([](JsonReader&, Scene& read) { read.camera = automatic; });
    scene
        .key("camera", &Scene::camera,
             automatic_form(object_form(table_of<camera_keys>), &nlohmann::json::is_object,
                            "an object {...}, or \"auto\""),
             "auto: chosen from the data (docs/first-picture.md).")
        .otherwise("auto");
}

void plane_keys(KeyTable<ClipPlane>& keys) {
    keys.key("point", &ClipPlane::point,
             checked(vector_form(), is_place, "coordinates from -1e100 to 1e100"),
             "Of the plane, world.")
        .required();
    keys.key("normal", &ClipPlane::normal,
             checked(
                 vector_form(), [](const glm::dvec3& v) { return v != glm::dvec3(0); },
                 "a direction [x, y, z] that is not zero"),
             "Towards what is kept; any length but 0.")
        .required();
}

void box_keys(KeyTable<ClipBox>& keys) {
    const auto place = checked(vector_form(), is_place, "coordinates from -1e100 to 1e100");
    keys.key("min", &ClipBox::min, place).required();
    keys.key("max", &ClipBox::max, place).required();
    keys.check([](JsonReader& reader, ClipBox& box) {
        for (int axis = 0; axis < 3; ++axis) {
            if (box.min[axis] <= box.max[axis]) continue;
            reader.reject("max", fmt::format("at least clip.box.min, ({}, {}, {}), on each axis",
                                             box.min.x, box.min.y, box.min.z));
        }
    });
}

void clip_keys(KeyTable<Clip>& keys) {
    keys.key("planes", &Clip::planes,
             list_form(table_of<plane_keys>, Clip::most_planes, "planes",
                       {{"maxItems", Clip::most_planes}}));
    keys.key("box", &Clip::box, optional_form(object_form(table_of<box_keys>)),
             "World; min at most max on each axis.");
}

void light_keys(KeyTable<Light>& keys) {
    keys.key("direction", &Light::direction,
             word_or_form("headlight", vector_form(), &nlohmann::json::is_array,
                          "\"headlight\" or three finite numbers [x, y, z]"),
             "Towards the light, in world space; headlight: towards the eye, along every ray.");
    keys.key("color", &Light::color, color_form(), "Components 0..1000.");
}

void lighting_keys(KeyTable<Lighting>& keys) {
    const auto term = number_form({.from = 0, .up_to = Lighting::largest_term});
    keys.key("ambient", &Lighting::ambient, term);
    keys.key("diffuse", &Lighting::diffuse, term);
    keys.key("specular", &Lighting::specular, term);
    keys.key("power", &Lighting::power, number_form({.from = 1, .up_to = Lighting::largest_power}),
             "Of the specular highlight.");
    keys.key("smallest_gradient", &Lighting::smallest_gradient,
             automatic_form(number_form({.from = Lighting::least_gradient,
                                         .up_to = Lighting::largest_gradient}),
                            &nlohmann::json::is_number, "\"auto\" or a number above 0"),
             "In scalar units per world unit: what is less steep fades into the unlit "
             "picture. auto: .01 of the range of values over the smallest distance of samples "
             "(meshes: over the mean edge).");
    keys.key("lights", &Lighting::lights,
             list_form(table_of<light_keys>, Lighting::most_lights, "",
                       {{"minItems", 1}, {"maxItems", Lighting::most_lights}}));
}

void add_lighting(KeyTable<Scene>& scene) {
    Form<Lighting> form = object_form(table_of<lighting_keys>);
    form.read = [](JsonReader& reader, const std::string& key) {
        JsonReader object = reader.object(key);
        Lighting lighting;
        table_of<lighting_keys>().read(object, lighting);
        if (const auto mistake = mistake_in(lighting))
            object.fail_at(mistake->key, mistake->message);
        return lighting;
    };
    Form<std::optional<Auto<Lighting>>> lit = optional_form(
        automatic_form(form, &nlohmann::json::is_object,
                       "an object {...}, true, \"auto\", or false for colours as they are"));
    lit.read = [read = lit.read](JsonReader& reader, const std::string& key) {
        const nlohmann::json& value = reader.value(key);
        if (!value.is_boolean()) return read(reader, key);
        return value.get<bool>() ? std::optional<Auto<Lighting>>(Lighting{}) : std::nullopt;
    };
    lit.schema["oneOf"].push_back(KeyJson::object({{"type", "boolean"}}));
    scene.key("lighting", &Scene::lighting, lit,
              "Emission is lit by the gradient of the scalar, on both of its sides; true: with all "
              "defaults; auto: if that shows surfaces of the data; absent or false: colours are "
              "shown as they are.");
}

void image_keys(KeyTable<Scene>& keys) {
    keys.key("width", &Scene::width, whole_form<int>(1, max_image_side));
    keys.key("height", &Scene::height, whole_form<int>(1, max_image_side));
    keys.check([](JsonReader& reader, Scene& scene) {
        const auto width = std::int64_t{scene.width}, height = std::int64_t{scene.height};
        if (width * height > max_image_pixels) {
            reader.fail_at("width", fmt::format("found {} x {} pixels, expected at most {} in all",
                                                width, height, max_image_pixels));
        }
    });
    keys.key("color_space", &Scene::color_space, words_form<ImageColorSpace>(),
             "What triples and colour maps are given in, and pictures composited in: linear "
             "light, or display values as VTK and ParaView do.");
    keys.key("background", &Scene::background, color_form());
    keys.key("transparent", &Scene::transparent, flag_form(),
             "PNG files and films have straight alpha and no background.");
    keys.key("png_bits", &Scene::png_bits, code_bits_form(), "Of each code in PNG files.");
    keys.key("annotations", &Scene::annotations, annotations_form(),
             "What is drawn beside the picture, in PNG files and on screens "
             "(docs/annotations.md).");
}

}  // namespace

void camera_keys(KeyTable<Camera>& keys) {
    keys.key("projection", &Camera::projection, words_form<Projection>());
    keys.key("eye", &Camera::eye, vector_form()).required();
    keys.key("center", &Camera::center, vector_form()).required();
    keys.key("up", &Camera::up, vector_form());
    keys.key("fov_y", &Camera::fov_y,
             number_form({.above = 0, .below = 180}, "degrees between 0 and 180"),
             "Degrees, perspective.");
    keys.check([](JsonReader& reader, Camera& camera) {
        if (camera.projection == Projection::orthographic) reader.number("height");
    });
    keys.key("height", &Camera::height, number_form({.above = 0}, "world units > 0"),
             "World units, orthographic (required there).")
        .without_default();
    keys.check(check_camera);
}

void add_view_keys(KeyTable<Scene>& scene) {
    add_camera(scene);
    Form<Clip> clip = object_form(table_of<clip_keys>);
    clip.write = [](const Clip& kept) {
        return kept.keeps_all() ? KeyJson() : table_of<clip_keys>().json(kept);
    };
    scene.key("clip", &Scene::clip, clip,
              "What is drawn of the data: what lies on the kept side of all planes and in the "
              "box. Nothing is cut away if it is left out.");
    add_lighting(scene);
    scene.object("image", table_of<image_keys>);
}

}  // namespace lamina
