// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <string>
#include <type_traits>

#include "bindings.h"
#include "drawn.h"
#include "shared_session.h"
#include "waiting.h"

namespace lamina::python {
namespace {

Auto<ContextChoice> context_of(const std::string& word) {
    if (word == "auto") return automatic;
    if (word == "osmesa") return ContextChoice::osmesa;
    if (word == "egl") return ContextChoice::egl;
    if (word == "cpu") return ContextChoice::cpu;
    throw py::value_error("context: found \"" + word +
                          "\", expected \"auto\", \"osmesa\", \"egl\" or \"cpu\"");
}

// Opens a session. `data`: a Volume, a MeshData, or None for the data that the scene names.
std::unique_ptr<SharedSession> opened(const Scene& scene, const py::object& data,
                                      const std::string& context, int threads, bool many_frames,
                                      const std::string& only_below) {
    SessionOptions options{context_of(context), threads, many_frames, only_below};
    std::optional<Volume> volume;
    std::shared_ptr<MeshData> mesh;
    if (py::isinstance<Volume>(data))
        volume = data.cast<Volume>();
    else if (!data.is_none())
        mesh = data.cast<std::shared_ptr<MeshData>>();
    std::unique_ptr<SharedSession> session;
    run_waiting([&](std::stop_token stop, const ProgressCallback&) {
        options.stop = std::move(stop);
        if (volume)
            session = std::make_unique<SharedSession>(scene, options, *volume);
        else if (mesh)
            session = std::make_unique<SharedSession>(scene, options, *mesh);
        else
            session = std::make_unique<SharedSession>(scene, options);
    });
    return session;
}

template <Drawn (SharedSession::*method)(std::stop_token, const ProgressCallback&)>
Drawn draw_with(SharedSession& session, const py::object& progress) {
    Drawn drawn;
    run_waiting(
        [&](std::stop_token stop, const ProgressCallback& said) {
            drawn = (session.*method)(std::move(stop), said);
        },
        progress);
    return drawn;
}

template <auto change>
void changed(SharedSession& session, const Scene& to) {
    run_waiting([&](const std::stop_token&, const ProgressCallback&) {
        session.change([&](Session& changing) { change(changing, to); });
    });
}

constexpr auto camera = [](Session& session, const Scene& to) { session.set_camera(*to.camera); };
constexpr auto size = [](Session& session, const Scene& to) {
    session.set_size(to.width, to.height);
};
constexpr auto transfer_function = [](Session& session, const Scene& to) {
    session.set_transfer_function_of(to);
};
constexpr auto clip = [](Session& session, const Scene& to) { session.set_clip(to.clip); };
constexpr auto everything = [](Session& session, const Scene& to) { session.set_scene(to); };
constexpr auto again = [](Session& session) { session.choose_again(); };

Words words_of(const py::dict& keywords) {
    Words words;
    for_each_word(words, [&](const char* name, auto& value) {
        if (keywords.contains(name))
            value = keywords[name].cast<std::remove_reference_t<decltype(value)>>();
    });
    return words;
}

// Changes the session by words. Returns the scene with what was chosen.
Scene adjusted(SharedSession& session, const py::dict& keywords) {
    const Words words = words_of(keywords);
    Scene scene;
    run_waiting([&](const std::stop_token&, const ProgressCallback&) {
        scene = session.change([&](Session& changing) {
            changing.adjust(words);
            return changing.chosen_scene();
        });
    });
    return scene;
}

}  // namespace

void bind_session(py::module_& module) {
    bind_drawn(module);
    py::class_<SharedSession>(module, "Session")
        .def(py::init(&opened), py::arg("scene"), py::arg("data"), py::arg("context"),
             py::arg("threads"), py::arg("many_frames"), py::arg("only_below"))
        .def("draw", &draw_with<&SharedSession::draw>, py::arg("progress"))
        .def("trace", &draw_with<&SharedSession::trace>, py::arg("progress"))
        .def("set_camera", &changed<camera>, py::arg("to"))
        .def("set_size", &changed<size>, py::arg("to"))
        .def("set_transfer_function", &changed<transfer_function>, py::arg("to"))
        .def("set_clip", &changed<clip>, py::arg("to"))
        .def("set_scene", &changed<everything>, py::arg("to"))
        .def("adjust", &adjusted, py::arg("words"))
        .def("choose_again",
             [](SharedSession& session) {
                 run_waiting([&](const std::stop_token&, const ProgressCallback&) {
                     session.change(again);
                 });
             })
        .def("resolved",
             [](SharedSession& session) {
                 Scene scene;
                 run_waiting([&](const std::stop_token&, const ProgressCallback&) {
                     scene = session.resolved_scene();
                 });
                 return scene;
             })
        .def("explanation", [](SharedSession& session) {
            std::string text;
            run_waiting([&](const std::stop_token&, const ProgressCallback&) {
                text = session.explanation();
            });
            return text;
        });
}

}  // namespace lamina::python
