// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "vectors.h"

namespace lamina::python {
namespace {

py::dict camera_keys(const Camera& camera) {
    py::dict keys;
    keys["projection"] = name_of(camera.projection);
    keys["eye"] = from_glm(camera.eye);
    keys["center"] = from_glm(camera.center);
    keys["up"] = from_glm(camera.up);
    keys["fov_y"] = camera.fov_y;
    keys["height"] = camera.height;
    return keys;
}

py::dict orbited(const Vector& lo, const Vector& hi, double azimuth, double elevation,
                 double fov_y) {
    return camera_keys(orbit({to_glm(lo), to_glm(hi)}, azimuth, elevation, fov_y));
}

template <typename Data>
py::dict fitted(const Scene& scene, const Data& data, double azimuth, double elevation) {
    Camera camera;
    {
        const py::gil_scoped_release released;
        camera = fitted_camera(scene, data, azimuth, elevation);
    }
    return camera_keys(camera);
}

}  // namespace

void bind_camera(py::module_& module) {
    module.def("orbit", &orbited, py::arg("lo"), py::arg("hi"), py::arg("azimuth"),
               py::arg("elevation"), py::arg("fov_y"));
    module.def("fit", &fitted<Volume>, py::arg("scene"), py::arg("data"), py::arg("azimuth"),
               py::arg("elevation"));
    module.def("fit", &fitted<MeshData>, py::arg("scene"), py::arg("data"), py::arg("azimuth"),
               py::arg("elevation"));
    module.def(
        "turned",
        [](const Scene& scene, double degrees) {
            return camera_keys(turned(*scene.camera, degrees));
        },
        py::arg("scene"), py::arg("degrees"));
}

}  // namespace lamina::python
