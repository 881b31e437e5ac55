// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <string_view>

#include "base/error.h"
#include "gl/api.h"
#include "gl/context.h"

// EGL is loaded by dlopen() and not linked: its headers declare types only.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace lamina::gl {

namespace {

// Constants of GL/osmesa.h, which Mesa 25.1 and later lack.
constexpr int osmesa_rgba = 0x1908;
constexpr int osmesa_format = 0x22;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_context_major_version = 0x36;
constexpr int osmesa_context_minor_version = 0x37;
constexpr int osmesa_type = 0x23;
constexpr unsigned gl_unsigned_byte = 0x1401;

using OsmesaHandle = struct OsmesaHandleType*;

constexpr std::initializer_list<const char*> library_names{"libOSMesa.so.8", "libOSMesa.so.6",
                                                           "libOSMesa.so"};

struct Osmesa {
    SharedLibrary library{library_names};
    OsmesaHandle (*create)(const int* attributes,
                           OsmesaHandle share) = library.function("OSMesaCreateContextAttribs");
    void (*destroy)(OsmesaHandle context) = library.function("OSMesaDestroyContext");
    unsigned char (*make_current)(OsmesaHandle context, void* buffer, unsigned type, int width,
                                  int height) = library.function("OSMesaMakeCurrent");
    OsmesaHandle (*current_context)() = library.function("OSMesaGetCurrentContext");
    unsigned char (*get_color_buffer)(OsmesaHandle context, int* width, int* height, int* format,
                                      void** buffer) = library.function("OSMesaGetColorBuffer");
    void (*get_integer)(int name, int* value) = library.function("OSMesaGetIntegerv");
    void (*(*get_proc_address)(const char* name))() = library.function("OSMesaGetProcAddress");
};

// Throws Error if GALLIUM_DRIVER is set, but not to llvmpipe: OSMesa crashes if it lacks a driver.
void check_driver_asked_for() {
    const char* const driver = std::getenv("GALLIUM_DRIVER");
    if (driver != nullptr && std::string_view(driver) != "llvmpipe")
        fail("GALLIUM_DRIVER is \"{}\", expected llvmpipe", driver);
}

const Osmesa& osmesa() {
    static const Osmesa loaded;
    return loaded;
}

class OsmesaContext : public Context {
  public:
    ~OsmesaContext() override {
        if (context_) osmesa().destroy(context_);
    }

    void open() {
        const int attributes[] = {osmesa_format,
                                  osmesa_rgba,
                                  osmesa_profile,
                                  osmesa_core_profile,
                                  osmesa_context_major_version,
                                  4,
                                  osmesa_context_minor_version,
                                  5,
                                  0};
        context_ = osmesa().create(attributes, nullptr);
        if (!context_) fail("it refused OpenGL 4.5 core (Mesa 17.3 or later with llvmpipe has it)");
        initialise(osmesa().get_proc_address, "OSMesa", true);
    }

  private:
    void bind() override {
        if (!osmesa().make_current(context_, pixel_.data(), gl_unsigned_byte, 1, 1))
            fail("OSMesaMakeCurrent failed");
    }

    void release() override { osmesa().make_current(nullptr, nullptr, 0, 0, 0); }

    OsmesaHandle context_ = nullptr;
    std::array<std::uint8_t, 4> pixel_{};  // the framebuffer that OSMesa demands; unused
};

constexpr const char* library_name = "libEGL.so.1";

// Loads EGL so that Mesa's loader does not report on stderr: failures reach the user as Error.
SharedLibrary load_quietly() {
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    return SharedLibrary{library_name};
}

struct Egl {
    SharedLibrary library = load_quietly();
    decltype(&eglGetProcAddress) get_proc_address = library.function("eglGetProcAddress");
    decltype(&eglGetError) get_error = library.function("eglGetError");
    decltype(&eglQueryString) query_string = library.function("eglQueryString");
    decltype(&eglInitialize) initialise = library.function("eglInitialize");
    decltype(&eglBindAPI) bind_api = library.function("eglBindAPI");
    decltype(&eglCreateContext) create_context = library.function("eglCreateContext");
    decltype(&eglDestroyContext) destroy_context = library.function("eglDestroyContext");
    decltype(&eglMakeCurrent) make_current = library.function("eglMakeCurrent");
    decltype(&eglQueryAPI) query_api = library.function("eglQueryAPI");
    decltype(&eglGetCurrentContext) current_context = library.function("eglGetCurrentContext");
    decltype(&eglGetCurrentDisplay) current_display = library.function("eglGetCurrentDisplay");
    decltype(&eglGetCurrentSurface) current_surface = library.function("eglGetCurrentSurface");
    // Functions of extensions; null if EGL lacks them.
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = extension("eglGetPlatformDisplayEXT");
    PFNEGLQUERYDEVICESEXTPROC query_devices = extension("eglQueryDevicesEXT");
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = extension("eglQueryDeviceStringEXT");

    AnyFunction extension(const char* name) const {
        return {reinterpret_cast<void*>(get_proc_address(name))};
    }
};

const Egl& egl() {
    static const Egl loaded;
    return loaded;
}

bool has_word(const char* words, std::string_view word) {
    std::string_view rest = words ? words : "";
    while (!rest.empty()) {
        const std::size_t end = rest.find(' ');
        if (rest.substr(0, end) == word) return true;
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    }
    return false;
}

std::string last_error() {
    static constexpr const char* names[] = {
        "EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
        "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
        "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
        "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
        "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
    const EGLint code = egl().get_error();
    const std::size_t index = static_cast<std::size_t>(code - EGL_SUCCESS);
    return index < std::size(names) ? names[index] : fmt::format("error {:#x}", code);
}

// An EGL display to open: of a device, or of a Mesa platform without display server.
struct Route {
    std::string name;
    EGLenum platform;
    void* native;
    bool software;
};

std::vector<Route> device_routes() {
    std::vector<EGLDeviceEXT> devices(64);
    EGLint count = 0;
    if (!egl().query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count))
        count = 0;

    std::vector<Route> hardware, software;
    for (EGLint i = 0; i < count; ++i) {
        const char* extensions = egl().query_device_string(devices[i], EGL_EXTENSIONS);
        const bool is_software = has_word(extensions, "EGL_MESA_device_software");
        std::vector<Route>& routes = is_software ? software : hardware;
        routes.push_back(
            {fmt::format("device {}", i), EGL_PLATFORM_DEVICE_EXT, devices[i], is_software});
    }
    hardware.insert(hardware.end(), software.begin(), software.end());
    return hardware;
}

// Lists all displays that may be opened, hardware first.
std::vector<Route> all_routes() {
    std::vector<Route> routes;
    const char* extensions = egl().query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!egl().get_platform_display) fail("EGL_EXT_platform_base is missing");
    if (has_word(extensions, "EGL_EXT_platform_device") && egl().query_devices &&
        egl().query_device_string) {
        routes = device_routes();
    }
    if (has_word(extensions, "EGL_MESA_platform_surfaceless"))
        routes.push_back({"surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, true});
    return routes;
}

class EglContext : public Context {
  public:
    // The display stays initialised for the next context: Mesa leaks when it unloads its driver.
    ~EglContext() override {
        if (context_ != EGL_NO_CONTEXT) egl().destroy_context(display_, context_);
    }

    void open(const Route& route) {
        display_ = egl().get_platform_display(route.platform, route.native, nullptr);
        if (display_ == EGL_NO_DISPLAY) fail("no display: {}", last_error());
        if (!egl().initialise(display_, nullptr, nullptr)) fail("eglInitialize: {}", last_error());
        const char* extensions = egl().query_string(display_, EGL_EXTENSIONS);
        for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"}) {
            if (!has_word(extensions, needed)) fail("{} is missing", needed);
        }
        create();
        initialise(egl().get_proc_address, "EGL", false);
    }

  private:
    void create() {
        const EGLenum api = egl().query_api();  // the API that the caller bound, to be bound again
        if (!egl().bind_api(EGL_OPENGL_API)) fail("no desktop OpenGL: {}", last_error());
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        context_ = egl().create_context(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        const std::string error = context_ == EGL_NO_CONTEXT ? last_error() : "";
        if (api != EGL_NONE) egl().bind_api(api);
        if (!error.empty()) fail("it refused OpenGL 4.5 core: {}", error);
    }

    void bind() override {
        egl().bind_api(EGL_OPENGL_API);
        if (!egl().make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
            fail("eglMakeCurrent: {}", last_error());
    }

    void release() override {
        egl().make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

std::unique_ptr<Context> first_that_opens(EglDevices devices) {
    std::vector<std::string> reasons;
    for (const Route& route : all_routes()) {
        if (devices == EglDevices::hardware && route.software) continue;
        try {
            auto context = std::make_unique<EglContext>();
            context->open(route);
            if (devices == EglDevices::hardware && context->capabilities().software)
                fail("is a software renderer ({})", context->capabilities().renderer);
            return context;
        } catch (const Error& error) {
            reasons.push_back(route.name + ": " + error.what());
        }
    }
    if (reasons.empty()) fail("no {}device", devices == EglDevices::hardware ? "hardware " : "");
    fail("{}", fmt::join(reasons, "; "));
}

}  // namespace

std::unique_ptr<Context> create_osmesa_context() {
    try {
        check_driver_asked_for();
        osmesa();
        auto context = std::make_unique<OsmesaContext>();
        context->open();
        return context;
    } catch (const Error& error) {
        fail("OSMesa: {}", error.what());
    }
}

OsmesaBinding release_osmesa() {
    OsmesaBinding found;
    if (std::ranges::none_of(library_names, SharedLibrary::is_loaded)) return found;
    const OsmesaHandle context = osmesa().current_context();
    if (context == nullptr) return found;
    int format = 0, type = 0;
    osmesa().get_color_buffer(context, &found.width, &found.height, &format, &found.buffer);
    osmesa().get_integer(osmesa_type, &type);
    osmesa().make_current(nullptr, nullptr, 0, 0, 0);
    found.context = context;
    found.type = static_cast<unsigned>(type);
    return found;
}

void restore(const OsmesaBinding& binding) {
    if (binding.context == nullptr) return;
    osmesa().make_current(static_cast<OsmesaHandle>(binding.context), binding.buffer, binding.type,
                          binding.width, binding.height);
}

std::unique_ptr<Context> create_egl_context(EglDevices devices) {
    try {
        egl();
        return first_that_opens(devices);
    } catch (const Error& error) {
        fail("EGL: {}", error.what());
    }
}

EglBinding release_egl() {
    EglBinding found;
    if (!SharedLibrary::is_loaded(library_name)) return found;
    found.api = egl().query_api();
    found.context = egl().current_context();
    if (found.context == EGL_NO_CONTEXT) return found;
    found.display = egl().current_display();
    found.draw = egl().current_surface(EGL_DRAW);
    found.read = egl().current_surface(EGL_READ);
    egl().make_current(found.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    return found;
}

void restore(const EglBinding& binding) {
    if (binding.context != EGL_NO_CONTEXT)
        egl().make_current(binding.display, binding.draw, binding.read, binding.context);
    if (binding.api != 0 && binding.api != EGL_NONE) egl().bind_api(binding.api);
}

}  // namespace lamina::gl
