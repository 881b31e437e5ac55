// SPDX-License-Identifier: Apache-2.0
#include "study/picture_key.h"

#include <cassert>
#include <glm/vec3.hpp>

#include "base/content_hash.h"
#include "scene/given_transfer.h"
#include "scene/half_space.h"
#include "volume/volume_store.h"

namespace lamina::study {
namespace {

void add(ContentHash& hash, const glm::dvec3& v) {
    for (int i = 0; i < 3; ++i) hash.add(v[i]);
}

void add(ContentHash& hash, const Lighting& lighting) {
    for (const double number : {lighting.ambient, lighting.diffuse, lighting.specular,
                                lighting.power, lighting.smallest_gradient.value_or(0)})
        hash.add(number);
    for (const Light& light : lighting.lights) {
        add(hash, light.direction.value_or(glm::dvec3(0)));
        add(hash, light.color);
    }
}

}  // namespace

std::string picture_key(const Scene& scene) {
    ContentHash hash;
    const Camera& camera = *scene.camera;
    hash.add(static_cast<double>(camera.projection));
    hash.add(camera.projection == Projection::perspective ? camera.fov_y : camera.height);
    hash.add(scene.width);
    hash.add(scene.height);
    add(hash, camera.eye);
    add(hash, camera.center);
    add(hash, camera.up);
    assert(!has_open_colormap(scene));
    hash.add(transfer_function_key(*scene.transfer_function));
    for (const HalfSpace& half : half_spaces(scene.clip)) {
        add(hash, half.point);
        add(hash, half.normal);
    }
    if (scene.lighting) add(hash, *scene.lighting);
    return hash.hex();
}

std::string transfer_function_key(const TransferFunction& transfer_function) {
    ContentHash hash;
    for (const TransferKnot& knot : transfer_function.knots()) {
        hash.add(knot.value);
        add(hash, knot.optics.color);
        hash.add(knot.optics.extinction);
        if (knot.smooth) hash.add("smooth");
    }
    return hash.hex();
}

std::string content_of(const Volume& volume) {
    ContentHash hash;
    const Grid& grid = volume.grid();
    hash.add(name_of(volume.type()));
    add(hash, grid.origin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        add(hash, grid.step[axis]);
        hash.add(static_cast<double>(grid.size[axis]));
        hash.add(static_cast<double>(grid.centering[axis]));
    }
    if (volume.in_memory())
        hash.add(volume.data(), volume.byte_count());
    else
        hash.add(volume.store().source().identity());
    return hash.hex();
}

std::string content_of(const SceneMesh& mesh) {
    ContentHash hash;
    const auto add_all = [&](const auto& values) {
        hash.add(values.data(), values.size() * sizeof(values[0]));
    };
    add_all(mesh.mesh.points());
    add_all(mesh.mesh.tets());
    add_all(mesh.scalar.values);
    return hash.hex();
}

std::string content_of(const Colormap& colormap) {
    ContentHash hash;
    hash.add(static_cast<double>(colormap.colors.size()));
    for (const ColorPoint& point : colormap.colors) {
        hash.add(point.value);
        add(hash, point.color);
    }
    for (const OpacityPoint& point : colormap.opacities) {
        hash.add(point.value);
        hash.add(point.opacity);
    }
    return hash.hex();
}

}  // namespace lamina::study
