// SPDX-License-Identifier: Apache-2.0
// Tests that the current context of a program that uses OpenGL itself is the same before and after
// it uses lamina.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <vector>

#include "gl/api.h"
#include "gl/framebuffer.h"
#include "gl_fixture.h"

namespace lamina::gl {
namespace {

constexpr unsigned color_buffer_bit = 0x4000, rgba = 0x1908, unsigned_byte = 0x1401;
constexpr unsigned floating = 0x1406;

// OpenGL's functions that the program (the test) calls itself.
struct CallersFunctions {
    void (*clear_color)(float, float, float, float);
    void (*clear)(unsigned);
    void (*finish)();
    void (*read_pixels)(int, int, int, int, unsigned, unsigned, void*);
    unsigned (*get_error)();

    template <typename Load>
    explicit CallersFunctions(const Load& load) {
        find(clear_color, load("glClearColor"));
        find(clear, load("glClear"));
        find(finish, load("glFinish"));
        find(read_pixels, load("glReadPixels"));
        find(get_error, load("glGetError"));
    }
    template <typename Function, typename Found>
    static void find(Function& function, Found found) {
        function = reinterpret_cast<Function>(found);
    }
};

// Draws in contexts of lamina, one current while another is current further out.
void draw_in_contexts() {
    for (const ContextKind kind : {ContextKind::osmesa, ContextKind::egl}) {
        if (kind == ContextKind::egl && !has_egl()) continue;
        const auto context = Context::create(kind);
        const auto inner = Context::create(ContextKind::osmesa);
        const CurrentContext current(*context);
        Framebuffer target(Texture::make_2d(TextureFormat::rgba8, 2, 2));
        target.clear(glm::vec4(1));
        const CurrentContext current_too(*inner);
        EXPECT_EQ(bytes_allocated(), 0);
    }
}

TEST(CallersContext, RemainsCurrentWithOsmesa) {
    const SharedLibrary library{"libOSMesa.so.8", "libOSMesa.so.6"};
    using Handle = void*;
    Handle (*const create)(unsigned, Handle) = library.function("OSMesaCreateContext");
    void (*const destroy)(Handle) = library.function("OSMesaDestroyContext");
    unsigned char (*const make_current)(Handle, void*, unsigned, int, int) =
        library.function("OSMesaMakeCurrent");
    Handle (*const current)() = library.function("OSMesaGetCurrentContext");
    void (*(*const load)(const char*))() = library.function("OSMesaGetProcAddress");

    const Handle context = create(rgba, nullptr);
    ASSERT_NE(context, nullptr);
    std::vector<float> picture(4 * 5 * 3);
    ASSERT_TRUE(make_current(context, picture.data(), floating, 5, 3));
    const CallersFunctions caller(load);
    caller.clear_color(.25, .5, .75, 1);
    draw_in_contexts();
    EXPECT_EQ(current(), context);
    caller.clear(color_buffer_bit);
    caller.finish();
    EXPECT_EQ(caller.get_error(), 0u);
    for (std::size_t i = 0; i < picture.size(); i += 4) {
        EXPECT_EQ(picture[i], .25f);
        EXPECT_EQ(picture[i + 2], .75f);
    }
    make_current(nullptr, nullptr, 0, 0, 0);
    destroy(context);
}

// The program has a context of OpenGL ES, an API that lamina never binds, with surfaces of two
// sizes.
class CallersEgl : public testing::Test {
  protected:
    void SetUp() override {
        if (!has_egl()) GTEST_SKIP() << "no libEGL.so.1";
        library_.emplace(std::initializer_list<const char*>{"libEGL.so.1"});
        const auto display_of = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
            call<decltype(&eglGetProcAddress)>("eglGetProcAddress")("eglGetPlatformDisplayEXT"));
        display_ = display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display_ == EGL_NO_DISPLAY ||
            !call<decltype(&eglInitialize)>("eglInitialize")(display_, nullptr, nullptr)) {
            GTEST_SKIP() << "no display without a device";
        }
        make_surfaces();
    }

    void TearDown() override {
        if (context_ == EGL_NO_CONTEXT) return;
        bind(EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        call<decltype(&eglDestroyContext)>("eglDestroyContext")(display_, context_);
        for (const EGLSurface surface : {draw_, read_})
            call<decltype(&eglDestroySurface)>("eglDestroySurface")(display_, surface);
    }

    template <typename Function>
    Function call(const char* name) const {
        return library_->function(name);
    }

    bool bind(EGLSurface draw, EGLSurface read, EGLContext context) const {
        return call<decltype(&eglMakeCurrent)>("eglMakeCurrent")(display_, draw, read, context);
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLSurface draw_ = EGL_NO_SURFACE, read_ = EGL_NO_SURFACE;
    EGLContext context_ = EGL_NO_CONTEXT;

  private:
    void make_surfaces() {
        ASSERT_TRUE(call<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_ES_API));
        const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                           EGL_OPENGL_ES2_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        call<decltype(&eglChooseConfig)>("eglChooseConfig")(display_, wanted.data(), &config, 1,
                                                            &count);
        if (count == 0) GTEST_SKIP() << "no configuration with pbuffers";
        const auto surface_of = [&](EGLint width) {
            const std::array<EGLint, 5> size{EGL_WIDTH, width, EGL_HEIGHT, 3, EGL_NONE};
            return call<decltype(&eglCreatePbufferSurface)>("eglCreatePbufferSurface")(
                display_, config, size.data());
        };
        draw_ = surface_of(4);
        read_ = surface_of(6);
        const std::array<EGLint, 3> version{EGL_CONTEXT_CLIENT_VERSION, 2, EGL_NONE};
        context_ = call<decltype(&eglCreateContext)>("eglCreateContext")(
            display_, config, EGL_NO_CONTEXT, version.data());
        ASSERT_TRUE(bind(draw_, read_, context_));
    }

    std::optional<SharedLibrary> library_;
};

TEST_F(CallersEgl, ContextRemainsCurrent) {
    const CallersFunctions caller(call<decltype(&eglGetProcAddress)>("eglGetProcAddress"));
    caller.clear_color(1, 0, 1, 1);
    draw_in_contexts();
    EXPECT_EQ(call<decltype(&eglGetCurrentContext)>("eglGetCurrentContext")(), context_);
    EXPECT_EQ(call<decltype(&eglGetCurrentDisplay)>("eglGetCurrentDisplay")(), display_);
    const auto surface = call<decltype(&eglGetCurrentSurface)>("eglGetCurrentSurface");
    EXPECT_EQ(surface(EGL_DRAW), draw_);
    EXPECT_EQ(surface(EGL_READ), read_);
    EXPECT_EQ(call<decltype(&eglQueryAPI)>("eglQueryAPI")(), EGLenum{EGL_OPENGL_ES_API});
    caller.clear(color_buffer_bit);
    ASSERT_TRUE(bind(draw_, draw_, context_));
    std::array<unsigned char, 4> pixel{};
    caller.read_pixels(3, 2, 1, 1, rgba, unsigned_byte, pixel.data());
    EXPECT_EQ(caller.get_error(), 0u);
    EXPECT_EQ(pixel, (std::array<unsigned char, 4>{255, 0, 255, 255}));
}

}  // namespace
}  // namespace lamina::gl
