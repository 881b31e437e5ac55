// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <string_view>

#include "base/error.h"
#include "gl/context_backends.h"
#include "gl/shared_library.h"

namespace lamina::gl {
namespace {

// From GL/osmesa.h, which Mesa 25.1 and later no longer have.
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
    OsmesaHandle (*create)(const int* attributes, OsmesaHandle share) =
        library.function<decltype(create)>("OSMesaCreateContextAttribs");
    void (*destroy)(OsmesaHandle context) =
        library.function<decltype(destroy)>("OSMesaDestroyContext");
    unsigned char (*make_current)(OsmesaHandle context, void* buffer, unsigned type, int width,
                                  int height) =
        library.function<decltype(make_current)>("OSMesaMakeCurrent");
    OsmesaHandle (*current_context)() =
        library.function<decltype(current_context)>("OSMesaGetCurrentContext");
    unsigned char (*get_color_buffer)(OsmesaHandle context, int* width, int* height, int* format,
                                      void** buffer) =
        library.function<decltype(get_color_buffer)>("OSMesaGetColorBuffer");
    void (*get_integer)(int name,
                        int* value) = library.function<decltype(get_integer)>("OSMesaGetIntegerv");
    void (*(*get_proc_address)(const char* name))() =
        library.function<decltype(get_proc_address)>("OSMesaGetProcAddress");
};

// Checks the driver that the environment asks for. OSMesa crashes where it does not have that
// driver, and only one driver has OpenGL 4.5.
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
    std::array<std::uint8_t, 4> pixel_{};  // the default framebuffer, which nobody draws into
};

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

}  // namespace lamina::gl
