// SPDX-License-Identifier: Apache-2.0
// The compiled part of the Python module: data, scenes and sessions of the library, as plainly as
// the package's Python code needs them. Users see that code (python/lamina), never this.
#include "bindings.h"

PYBIND11_MODULE(_lamina, module) {
    using namespace lamina::python;
    module.doc() = "What the package lamina is made of; use lamina itself.";
    module.attr("version") = LAMINA_VERSION;
    bind_errors(module);
    // Before what takes it: signatures name types that are known.
    bind_volume(module);
    bind_scene(module);
    bind_mesh(module);
    bind_sampling(module);
    bind_camera(module);
    bind_session(module);
    bind_pictures(module);
    bind_study(module);
}
