// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

namespace lamina::python {

void bind_errors(py::module_&) {
    // Never destroyed: the translator may run as long as the process does.
    static const py::object& error =
        *new py::object(py::module_::import("lamina._errors").attr("Error"));
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Interrupted&) {
            PyErr_SetNone(PyExc_KeyboardInterrupt);
        } catch (const Error& found) {
            PyErr_SetString(error.ptr(), found.what());
        }
    });
}

}  // namespace lamina::python
