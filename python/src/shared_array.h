// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bindings.h"

namespace lamina::python {

// Returns an array over memory that `owner` keeps.
template <typename Element, typename Owner>
py::array array_over(const Element* first, std::vector<py::ssize_t> shape,
                     std::shared_ptr<Owner> owner) {
    const py::capsule keeper(new std::shared_ptr<Owner>(std::move(owner)),
                             [](void* kept) { delete static_cast<std::shared_ptr<Owner>*>(kept); });
    return py::array_t<Element>(std::move(shape), first, keeper);
}

// Returns such an array that cannot be written to.
template <typename Element, typename Owner>
py::array constant_array_over(const Element* first, std::vector<py::ssize_t> shape,
                              std::shared_ptr<Owner> owner) {
    py::array array = array_over(first, std::move(shape), std::move(owner));
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

// Keeps the caller's Python object as long as the pointer, also in threads without the GIL.
inline std::shared_ptr<const void> keep(py::object object, const void* data) {
    auto* const kept = new py::object(std::move(object));
    const std::shared_ptr<py::object> holder(kept, [](py::object* last) {
        if (Py_IsInitialized() == 0) return;  // its memory ends with the process
        const py::gil_scoped_acquire held;
        delete last;
    });
    return {holder, data};
}

}  // namespace lamina::python
