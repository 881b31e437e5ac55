// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "waiting.h"

namespace lamina::python {
namespace {

// (runs, findings, failures, messages)
py::tuple run(const std::filesystem::path& study, const std::filesystem::path& folder, bool resume,
              const py::object& progress) {
    StudyOutcome outcome;
    run_waiting(
        [&](std::stop_token stop, const ProgressCallback& said) {
            outcome = run_study(study, folder, resume, std::move(stop), said);
        },
        progress);
    return py::make_tuple(outcome.runs, outcome.findings, outcome.failures, outcome.messages);
}

}  // namespace

void bind_study(py::module_& module) {
    module.def("run_study", &run, py::arg("study"), py::arg("folder"), py::arg("resume"),
               py::arg("progress"));
}

}  // namespace lamina::python
