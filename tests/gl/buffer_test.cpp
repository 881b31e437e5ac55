// SPDX-License-Identifier: Apache-2.0
#include "gl/api.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/sync.h"
#include "gl/texture.h"
#include "gl_fixture.h"
#include "support/expect_error.h"

namespace lamina::gl {
namespace {

using BufferTest = GlTest;

TEST_F(BufferTest, ReachesTheShaderAsStorageBlocks) {
    const std::array<float, 4> slab{1, 2, 3, 4};
    std::vector<float> values{10, 20, 30, 40};
    const Buffer first{std::span(slab)};
    Buffer storage{std::span(values)};
    const std::array<float, 1> changed{50};
    storage.write(std::span(changed), 2 * sizeof(float));
    first.bind_storage(1);
    storage.bind_storage(2);

    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 4, 1));
    target.bind();
    draw_full_screen(full_screen_program(R"(#version 450 core
        layout(std430, binding = 1) readonly buffer Slab { vec4 slab; };
        layout(std430, binding = 2) readonly buffer Values { float values[]; };
        out vec4 color;
        void main() { color = slab + values[int(gl_FragCoord.x)]; }
    )"));
    const Image image = target.read_back();
    const float expected[4] = {10, 20, 50, 40};
    for (int x = 0; x < 4; ++x) {
        for (int c = 0; c < 4; ++c) {
            EXPECT_EQ(image.pixel(x, 0)[c], expected[x] + slab[static_cast<std::size_t>(c)]);
        }
    }
}

TEST_F(BufferTest, IsWrittenByDispatchesOneAfterTheOther) {
    Buffer storage(8 * sizeof(std::uint32_t));
    storage.clear();
    Program program = compute_program(R"(#version 450 core
        layout(local_size_x = 4) in;
        layout(std430, binding = 1) buffer Sums { uint sums[]; };
        uniform int factor;
        void main() { sums[gl_GlobalInvocationID.x] = sums[gl_GlobalInvocationID.x] * 3u + uint(factor); }
    )");
    storage.bind_storage(1);
    program.set("factor", 5);
    program.dispatch(2);
    program.set("factor", 7);
    program.dispatch(1);
    std::array<std::uint32_t, 3> found{};
    storage.read(std::span(found), 2 * sizeof(std::uint32_t));
    EXPECT_EQ(found, (std::array<std::uint32_t, 3>{22, 22, 5}));
}

TEST_F(BufferTest, CountsItsBytesAlsoWhenMoved) {
    EXPECT_EQ(bytes_allocated(), 0);
    Buffer first(100);
    EXPECT_EQ(bytes_allocated(), 100);
    Buffer second(28);
    EXPECT_EQ(bytes_allocated(), 128);
    first = std::move(second);
    second = Buffer();
    EXPECT_EQ(bytes_allocated(), 28);
    EXPECT_EQ(first.byte_count(), 28u);
    const Buffer third(std::move(first));
    EXPECT_EQ(bytes_allocated(), 28);
}

using ReadBackTest = EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, ReadBackTest, both_contexts, context_name);

// Counts up in a buffer that is mapped in software and in one that never is.
TEST_P(ReadBackTest, FindsWhatDispatchesWroteBeforeIt) {
    constexpr int numbers = 3 << 14;
    Program program = compute_program(R"(#version 450 core
        layout(local_size_x = 64) in;
        layout(std430, binding = 1) buffer Numbers { uint numbers[]; };
        uniform int factor;
        void main() {
            uint i = gl_GlobalInvocationID.x;
            numbers[i] = numbers[i] + uint(factor) * i;
        }
    )");
    ReadBack reading;
    for (const bool readable : {true, false}) {
        constexpr std::size_t bytes = numbers * sizeof(std::uint32_t);
        Buffer storage = readable ? Buffer::make_readable(bytes) : Buffer(bytes);
        EXPECT_EQ(storage.mapped() != nullptr, readable && capabilities().software);
        storage.clear();
        storage.bind_storage(1);
        std::uint32_t sum = 0;
        for (const int factor : {5, 70000}) {
            program.set("factor", factor);
            program.dispatch(numbers / 64);
            reading.take(storage);
            sum += static_cast<std::uint32_t>(factor);
            const auto found = reading.values<std::uint32_t>();
            ASSERT_EQ(found.size(), std::size_t{numbers});
            for (std::size_t i = 0; i < found.size(); ++i)
                ASSERT_EQ(found[i], sum * static_cast<std::uint32_t>(i)) << readable;
        }
    }
}

// A copy is complete although the buffer is written again before anyone looks at it.
TEST_P(ReadBackTest, KeepsWhatWasTakenFromABufferThatIsWrittenAgain) {
    const std::array<std::uint32_t, 3> before{1, 2, 3}, after{4, 5, 6};
    Buffer storage{std::span(before)};
    ReadBack reading;
    reading.take(storage);
    storage.write(std::span(after));
    EXPECT_TRUE(std::ranges::equal(reading.values<std::uint32_t>(), before));
    reading.take(storage);
    EXPECT_TRUE(std::ranges::equal(reading.values<std::uint32_t>(), after));
}

TEST_P(ReadBackTest, TakesPartsOfBuffersAndTextures) {
    const std::array<std::uint32_t, 5> numbers{1, 2, 3, 4, 5};
    ReadBack reading;
    reading.take(Buffer{std::span(numbers)}, 4, 12);
    EXPECT_TRUE(std::ranges::equal(reading.values<std::uint32_t>(), std::array{2u, 3u, 4u}));
    const std::array<float, 6> columns_of_rows{1, 2, 3, 4, 5, 6};
    Texture texture = Texture::make_2d(TextureFormat::r32f, 2, 3);
    texture.upload({.width = 2, .height = 3}, std::span<const float>(columns_of_rows));
    reading.take(texture, 1, 2);
    const auto rgba = reading.values<float>();
    ASSERT_EQ(rgba.size(), 16u);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rgba[4 * i], columns_of_rows[2 + i]);
}

// Replaces the function of OpenGL that waits, during its lifetime.
class Waiting {
  public:
    explicit Waiting(PFNGLCLIENTWAITSYNCPROC function)
        : before_(std::exchange(changed().ClientWaitSync, function)) {}
    ~Waiting() { changed().ClientWaitSync = before_; }

  private:
    static GladGLContext& changed() { return const_cast<GladGLContext&>(api()); }
    PFNGLCLIENTWAITSYNCPROC before_;
};

TEST_P(ReadBackTest, AFenceThatCannotBeWaitedForIsAnError) {
    Fence fence;
    fence.set();
    const Waiting fails([](GLsync, GLbitfield, GLuint64) -> GLenum { return GL_WAIT_FAILED; });
    expect_error([&] { fence.wait(); }, {"OpenGL: waiting for the GPU failed: "});
}

// A picture of software may take more than a minute, a dispatch of a GPU may not.
TEST_P(ReadBackTest, AFenceWaitsLongForSoftwareAlone) {
    static int calls;
    calls = 0;
    const Waiting slow([](GLsync, GLbitfield, GLuint64) -> GLenum {
        return ++calls < 4 ? GL_TIMEOUT_EXPIRED : GL_CONDITION_SATISFIED;
    });
    Fence fence;
    fence.set();
    if (capabilities().software) {
        fence.wait();
        EXPECT_EQ(calls, 4);
    } else {
        expect_error([&] { fence.wait(); }, {"OpenGL: the GPU was not done within 60 s"});
    }
}

// A smaller thing is read into the memory of a larger one.
TEST_P(ReadBackTest, TakesTexturesOfAllSizesAndFormats) {
    ReadBack reading;
    std::vector<float> halves(std::size_t{4} * 7 * 5 * 2);
    for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = static_cast<float>(i) / 2;
    Texture large = Texture::make_3d(TextureFormat::rgba16f, 7, 5, 2);  // these are exact in it
    large.upload({0, 0, 0, 7, 5, 2}, std::span<const float>(halves));
    reading.take(large);
    EXPECT_TRUE(std::ranges::equal(reading.values<float>(), halves));
    const std::array<std::uint8_t, 3> codes{0, 255, 0};
    Texture small = Texture::make_1d(TextureFormat::r8, 3);
    small.upload({.width = 3}, std::span<const std::uint8_t>(codes));
    reading.take(small);
    EXPECT_TRUE(std::ranges::equal(reading.values<float>(),
                                   std::array<float, 12>{0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1}));
}

// Draws two triangles, which cover the left and the right half of the target, with indices and a
// different integer for each.
TEST_F(BufferTest, FeedsVertexAttributesAndIndices) {
    struct Vertex {
        float x, y;
        int layer;
    };
    const std::vector<Vertex> vertices{{-1, -1, 3}, {0, -1, 3}, {0, 1, 3}, {-1, 1, 3},
                                       {0, -1, 7},  {1, -1, 7}, {1, 1, 7}, {0, 1, 7}};
    const std::vector<unsigned> corners{0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    const Buffer vertex_buffer{std::span(vertices)};
    const Buffer index_buffer{std::span(corners)};
    VertexArray array;
    array.set_floats(0, vertex_buffer, 2, sizeof(Vertex), offsetof(Vertex, x));
    array.set_integers(1, vertex_buffer, 1, sizeof(Vertex), offsetof(Vertex, layer));
    array.set_indices(index_buffer);

    const ShaderFinder shaders = with_shaders({{"test.vert", R"(#version 450 core
        layout(location = 0) in vec2 position;
        layout(location = 1) in int layer;
        flat out int fragment_layer;
        void main() { gl_Position = vec4(position, 0, 1); fragment_layer = layer; }
    )"},
                                               {"test.frag", R"(#version 450 core
        flat in int fragment_layer;
        out vec4 color;
        void main() { color = vec4(fragment_layer); }
    )"}});
    const Program program(ShaderSources{compose_shader("test.vert", {}, shaders),
                                        compose_shader("test.frag", {}, shaders)});
    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 6, 5));
    target.bind();
    array.bind();
    program.use();
    api().DrawElements(GL_TRIANGLES, static_cast<GLsizei>(corners.size()), GL_UNSIGNED_INT,
                       nullptr);
    const Image image = target.read_back();
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 6; ++x) EXPECT_EQ(image.pixel(x, y)[0], x < 3 ? 3.0f : 7.0f);
    }
}

}  // namespace
}  // namespace lamina::gl
