// SPDX-License-Identifier: Apache-2.0
#include "gl/context.h"

#include <glad/gl.h>

#include <array>
#include <barrier>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "base/error.h"
#include "gl/api.h"
#include "gl/framebuffer.h"
#include "gl_fixture.h"
#include "support/expect_error.h"

namespace lamina::gl {
namespace {

using AnyContext = EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, AnyContext, both_contexts, context_name);

// Clears a new target to a value that RGBA32F holds exactly, and returns what it reads back.
float cleared_value(float value) {
    Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 3, 2));
    target.clear(glm::vec4(value));
    return target.read_back().pixel(2, 1)[3];
}

TEST_P(AnyContext, DescribesItself) {
    const std::string prefix = GetParam() == ContextKind::osmesa ? "OSMesa: " : "EGL: ";
    EXPECT_EQ(capabilities().renderer.rfind(prefix, 0), 0u) << capabilities().renderer;
    EXPECT_GT(capabilities().renderer.size(), prefix.size());
    // OpenGL 4.5 guarantees these sizes (table 23.53).
    EXPECT_GE(capabilities().max_texture_size, 16384);
    EXPECT_GE(capabilities().max_3d_texture_size, 2048);
    if (GetParam() == ContextKind::osmesa) {
        EXPECT_TRUE(capabilities().software);
    }
    const std::uint64_t usual = Capabilities{}.max_texture_bytes;
    if (capabilities().software) {
        EXPECT_EQ(capabilities().max_texture_bytes, usual);
    } else {
        EXPECT_GE(capabilities().max_texture_bytes, usual);
    }
}

// Sets LAMINA_RAYS during its lifetime.
class RaysVariable {
  public:
    explicit RaysVariable(const char* words) { setenv("LAMINA_RAYS", words, 1); }
    ~RaysVariable() { unsetenv("LAMINA_RAYS"); }
};

TEST(ContextRays, AreMarchedAsTheVariableSays) {
    const RaysVariable set("texels,128,blocks,sorted,alone");
    const auto context = Context::create(ContextKind::osmesa);
    EXPECT_EQ(context->capabilities().rays, (RayDispatch{128, false, true, true, true}));
    EXPECT_EQ(context->capabilities().sample_words, false);
}

TEST(ContextRays, RefuseOtherWords) {
    const auto make = [] { Context::create(ContextKind::osmesa); };
    const RaysVariable unknown("texels,96");
    EXPECT_EQ(
        error_of(make),
        "LAMINA_RAYS: found 96, expected words, texels, 32, 64, 128, queue, blocks, sorted or "
        "alone");
    const RaysVariable queue("queue");
    expect_error(make, {"LAMINA_RAYS: queue is for GPUs"});
}

TEST_P(AnyContext, HasNoErrorToBeginWith) {
    EXPECT_NO_THROW(check("beginning"));
}

TEST_P(AnyContext, MeasuresTheFloatFilter) {
    const double error = measure_filter_error(TextureFormat::r32f).found;
    EXPECT_EQ(capabilities().exact_float_filter, error <= 1e-6);
    // Software computes in float32: three nested interpolations of values below 1, each with at
    // most 3 roundings of 2^-24, give 9 * 2^-24 = 5.4e-7. The 8-bit weights of a GPU are off by up
    // to 1/512 along each axis: 3 / 512 = 6e-3.
    EXPECT_LE(error, capabilities().software ? 5.4e-7 : 6e-3);
    // Even correctly rounded float32 results have errors up to 2^-25, so an error of 0 would mean
    // that nothing was measured.
    EXPECT_GT(error, 0.0);
}

// On an r8 texture software also rounds results to codes, perhaps at each of three interpolations,
// each time by up to half a code where values span 7 codes. The error of a picture cannot be
// predicted with such a filter.
TEST_P(AnyContext, MeasuresTheFiltersOfCodes) {
    const FilterError bytes = measure_filter_error(TextureFormat::r8);
    const FilterError words = measure_filter_error(TextureFormat::r16);
    for (const FilterError& error : {bytes, words}) {
        EXPECT_GT(error.found, 0.0);
        // Weights of 8 bits are off by up to 1/512 along each axis, so the error is at most 3 /
        // 512. At scattered positions some error is about a third of that.
        EXPECT_LE(error.eight_bit, 3. / 512);
        EXPECT_GE(error.eight_bit, 1. / 512 * .8);
    }
    EXPECT_LE(bytes.found, 3. / 512 + (capabilities().software ? 1.5 / 7 : 0));
    EXPECT_LE(words.found, 3. / 512);
    if (!bytes.as_good_as_eight_bits()) {
        EXPECT_FALSE(capabilities().eight_bit_filter);
    }
    // A filter with truncated weights has nearly twice the error, and is refused.
    EXPECT_TRUE((FilterError{bytes.eight_bit, bytes.eight_bit}).as_good_as_eight_bits());
    EXPECT_FALSE((FilterError{1.8 * bytes.eight_bit, bytes.eight_bit}).as_good_as_eight_bits());
}

TEST_P(AnyContext, TurnsErrorsIntoExceptions) {
    api().Enable(GL_TEXTURE_2D);  // an error in the core profile
    try {
        check("testing");
        FAIL() << "no exception";
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind("OpenGL: GL_INVALID_ENUM while testing", 0), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    EXPECT_NO_THROW(check("testing again"));
}

TEST(Context, TakesNoSoftwareForAGpu) {
    try {
        EXPECT_FALSE(Context::create(ContextKind::gpu)->capabilities().software);
    } catch (const Error& error) {  // no context is current here
        EXPECT_NE(std::string(error.what()).find("--context cpu"), std::string::npos);
    }
}

TEST(Context, AlternatesBetweenOsmesaAndEgl) {
    if (!has_egl()) GTEST_SKIP() << "no libEGL.so.1";
    for (int round = 0; round < 3; ++round) {
        for (const ContextKind kind : {ContextKind::osmesa, ContextKind::egl}) {
            const auto context = Context::create(kind);
            const CurrentContext current(*context);
            const float value = static_cast<float>(round) + 0.25f;
            EXPECT_EQ(cleared_value(value), value) << context->capabilities().renderer;
        }
    }
}

// Draws many different pictures and counts their wrong pixels. Pixels are sums of small integers,
// which float32 holds exactly.
int wrong_pixels(Context& context, int first_value, std::barrier<>& together) {
    const CurrentContext current(context);
    Program program = full_screen_program(
        "#version 450 core\n"
        "uniform float value;\n"
        "out vec4 color;\n"
        "void main() { color = vec4(value + floor(gl_FragCoord.x) + floor(gl_FragCoord.y)); }\n");
    Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 37, 23));
    int wrong = 0;
    for (int round = 0; round < 100; ++round) {
        together.arrive_and_wait();
        program.set("value", static_cast<float>(first_value + round));
        target.bind();
        draw_full_screen(program);
        const Image image = target.read_back();
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const int exact = first_value + round + x + image.height - 1 - y;
                wrong += image.pixel(x, y)[1] != static_cast<float>(exact);
            }
        }
    }
    return wrong + (bytes_allocated() != 2 * 37 * 23 * 16);  // the picture and its copy
}

TEST(Context, TwoInTwoThreadsDrawIndependently) {
    using Pair = std::pair<ContextKind, ContextKind>;
    for (const auto& [kind, other_kind] :
         {Pair{ContextKind::osmesa, ContextKind::osmesa},
          Pair{ContextKind::osmesa, ContextKind::egl}, Pair{ContextKind::egl, ContextKind::egl}}) {
        if (other_kind == ContextKind::egl && !has_egl()) GTEST_SKIP() << "no libEGL.so.1";
        const auto context = Context::create(kind);
        std::barrier together(2);
        int others_wrong = -1;
        std::thread other([&] {
            const auto own = Context::create(other_kind);  // made while this thread draws nothing
            others_wrong = wrong_pixels(*own, 5000, together);
        });
        EXPECT_EQ(wrong_pixels(*context, 0, together), 0);
        other.join();
        EXPECT_EQ(others_wrong, 0);
    }
}

TEST(Context, GoesFromThreadToThread) {
    const auto context = Context::create(ContextKind::osmesa);
    std::optional<Texture> texture;
    std::thread([&] {
        const CurrentContext current(*context);
        texture = Texture::make_1d(TextureFormat::r8, 3);
        const std::array<std::uint8_t, 3> texels{255, 0, 255};
        texture->upload({.width = 3}, std::span<const std::uint8_t>(texels));
    }).join();
    const CurrentContext current(*context);
    EXPECT_EQ(texture->read_rgba()[8], 1.f);
    std::thread([&] {
        expect_error([&] { const CurrentContext other(*context); }, {"current in another thread"});
    }).join();
    texture.reset();
}

// Objects of the two contexts have the same ids, so a mix-up would show.
TEST(Context, TwoTakeTurnsInOneThread) {
    const auto outer = Context::create(ContextKind::osmesa);
    const auto inner = Context::create(has_egl() ? ContextKind::egl : ContextKind::osmesa);
    EXPECT_EQ(current_context(), nullptr);
    const CurrentContext current(*outer);
    Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 3, 2));
    target.clear(glm::vec4(.5));
    for (int round = 0; round < 3; ++round) {
        {
            const CurrentContext other(*inner);
            EXPECT_EQ(bytes_allocated(), 0);
            const float value = static_cast<float>(round) + 0.25f;
            EXPECT_EQ(cleared_value(value), value);
            const CurrentContext back(*outer);
            EXPECT_EQ(target.read_back().pixel(2, 1)[3], .5f);
            const CurrentContext again(*outer);
            EXPECT_EQ(current_context(), outer.get());
        }
        EXPECT_EQ(current_context(), outer.get());
        EXPECT_EQ(bytes_allocated(), 2 * 3 * 2 * 16);  // the target and its copy
        EXPECT_EQ(target.read_back().pixel(2, 1)[3], .5f);
    }
}

TEST(Context, AutomaticNeverTakesSoftwareThroughEglWhileOsmesaIsThere) {
    const auto context = Context::create(ContextKind::any);
    const Capabilities& capabilities = context->capabilities();
    const bool through_osmesa = capabilities.renderer.rfind("OSMesa: ", 0) == 0;
    EXPECT_EQ(through_osmesa, capabilities.software) << capabilities.renderer;
}

// A death test, in a process of its own, because Mesa reads the environment only once.
TEST(ContextDeathTest, ErrorsSayWhatWasTriedAndWhatToDo) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    const auto create_on_old_mesa = [] {
        setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
        try {
            Context::create(ContextKind::osmesa);
        } catch (const Error& error) {
            std::fputs(error.what(), stderr);
            std::exit(1);
        }
        std::exit(0);
    };
    EXPECT_EXIT(create_on_old_mesa(), testing::ExitedWithCode(1),
                "no OpenGL 4.5 core context \\(OSMesa: it refused OpenGL 4.5 core.*--context egl");
}

TEST(SharedLibrary, SaysWhatIsMissing) {
    try {
        SharedLibrary({"libnothing_a.so.1", "libnothing_b.so"});
        FAIL() << "no exception";
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("libnothing_a.so.1"), std::string::npos) << message;
        EXPECT_NE(message.find("libnothing_b.so"), std::string::npos) << message;
    }
    const SharedLibrary c_library{"libc.so.6"};
    EXPECT_THROW(c_library.function("no_such_function_at_all"), Error);
}

}  // namespace
}  // namespace lamina::gl
