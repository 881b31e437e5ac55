// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <lamina/lamina.h>

namespace lamina::python {

namespace py = pybind11;

// One for each source file: what it adds to the module.
void bind_errors(py::module_& module);
void bind_volume(py::module_& module);
void bind_mesh(py::module_& module);
void bind_sampling(py::module_& module);
void bind_scene(py::module_& module);
void bind_camera(py::module_& module);
void bind_session(py::module_& module);
void bind_pictures(py::module_& module);
void bind_study(py::module_& module);

}  // namespace lamina::python
