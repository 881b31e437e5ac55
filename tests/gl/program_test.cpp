// SPDX-License-Identifier: Apache-2.0
#include "gl/program.h"

#include <string>
#include <vector>

#include "base/error.h"
#include "gl/context.h"
#include "gl/framebuffer.h"
#include "gl_fixture.h"

namespace lamina::gl {
namespace {

using ProgramTest = EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, ProgramTest, both_contexts, context_name);

TEST_P(ProgramTest, SetsEveryKindOfUniform) {
    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 1, 1));
    target.bind();
    Program program = full_screen_program(R"(#version 450 core
        uniform float scalar;
        uniform double accurate;
        uniform int whole;
        uniform vec2 pair;
        uniform vec3 triple;
        uniform vec4 quadruple[2];
        uniform ivec2 whole_pair;
        uniform ivec3 whole_triple;
        uniform mat4 matrix;
        out vec4 color;
        void main() {
            float low = float((accurate - 1.0LF) * 1099511627776.0LF);  // lost in float
            float digits = triple.x + 10 * triple.y + 100 * triple.z;
            color = vec4(scalar + whole, pair.x + 10 * pair.y, digits, low)
                + quadruple[1] + vec4(whole_pair, 0, 0) * 1000 + vec4(whole_triple, 0) * 10000
                + matrix * vec4(0, 1, 0, 0);
        }
    )");
    program.set("scalar", 0.5f);
    program.set("accurate", 1 + 3 * 0x1p-40);
    program.set("whole", 2);
    program.set("pair", glm::vec2(1, 2));
    program.set("triple", glm::vec3(1, 2, 3));
    program.set("quadruple[1]", glm::vec4(0, 0, 0, 7));
    program.set("whole_pair", glm::ivec2(3, 4));
    program.set("whole_triple", glm::ivec3(5, 6, 7));
    glm::mat4 matrix(0.0f);
    matrix[1] = glm::vec4(0.25f, 0.5f, 0.75f, 1);  // glm and GLSL both index columns
    program.set("matrix", matrix);
    draw_full_screen(program);
    const Image image = target.read_back();
    EXPECT_EQ(image.pixel(0, 0)[0], 2.5f + 3000 + 50000 + 0.25f);
    EXPECT_EQ(image.pixel(0, 0)[1], 21 + 4000 + 60000 + 0.5f);
    EXPECT_EQ(image.pixel(0, 0)[2], 321 + 70000 + 0.75f);
    EXPECT_EQ(image.pixel(0, 0)[3], 8.0f + 3);
}

TEST_P(ProgramTest, IgnoresUnusedUniformsButNotMisspeltOnes) {
    Program program = full_screen_program(R"(#version 450 core
        uniform float unused;
        #if SHADED
        uniform float light;
        #endif
        out vec4 color;
        void main() { color = vec4(1); }
    )",
                                          Defines().set("SHADED", 0));
    EXPECT_NO_THROW(program.set("unused", 1.0f));
    EXPECT_NO_THROW(program.set("light", 1.0f));
    EXPECT_THROW(program.set("lights", 1.0f), Error);
    EXPECT_THROW(program.set("ligh", 1.0f), Error);
}

TEST_P(ProgramTest, IsSpecializedByDefines) {
    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 1, 1));
    target.bind();
    draw_full_screen(full_screen_program(
        "#version 450 core\nout vec4 color;\nvoid main() { color = vec4(FIRST, SECOND, 0, 0); }\n",
        Defines().set("FIRST", 3).set("SECOND", "(FIRST + 1)")));
    const Image image = target.read_back();
    EXPECT_EQ(image.pixel(0, 0)[0], 3.0f);
    EXPECT_EQ(image.pixel(0, 0)[1], 4.0f);
}

std::string compile_error(const std::map<std::string, std::string>& texts, const Defines& defines) {
    try {
        Program(ShaderSources{compose_shader("gl/full_screen.vert"),
                              compose_shader("test.frag", defines, with_shaders(texts))});
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST_P(ProgramTest, CompileErrorsNameShaderFileLineAndDefines) {
    const std::string included =
        compile_error({{"test.frag",
                        "#version 450 core\n#include \"lib/bad.glsl\"\nout vec4 color;\n"
                        "void main() { color = vec4(f()); }\n"},
                       {"lib/bad.glsl", "// line 1\n// line 2\nfloat f() { return nonsense; }\n"}},
                      Defines().set("BITS", 8));
    EXPECT_EQ(included.rfind("shader test.frag does not compile: lib/bad.glsl:3: ", 0), 0u)
        << included;
    EXPECT_NE(included.find("nonsense"), std::string::npos) << included;
    EXPECT_NE(included.find("BITS=8"), std::string::npos) << included;

    const std::string main =
        compile_error({{"test.frag",
                        "#version 450 core\n#include \"lib/good.glsl\"\nout vec4 color;\n"
                        "void main() { color = nonsense; }\n"},
                       {"lib/good.glsl", "float f() { return 1.0; }\n"}},
                      {});
    EXPECT_EQ(main.rfind("shader test.frag does not compile: test.frag:4: ", 0), 0u) << main;
    EXPECT_EQ(main.find('\n'), std::string::npos);
}

// A file that is included twice is compiled once, also if the first include is under an #if that is
// not taken.
TEST_P(ProgramTest, CompilesIncludedFilesOnce) {
    const std::map<std::string, std::string> texts{
        {"test.frag",
         "#version 450 core\n#if FAST\n#include \"a.glsl\"\n#endif\n#include \"a.glsl\"\n"
         "#include \"b.glsl\"\nout vec4 color;\nvoid main() { color = vec4(a() + b()); }\n"},
        {"a.glsl", "float a() { return 1.0; }\n"},
        {"b.glsl", "#include \"a.glsl\"\nfloat b() { return a(); }\n"}};
    EXPECT_EQ(compile_error(texts, Defines().set("FAST", 0)), "no error");
    EXPECT_EQ(compile_error(texts, Defines().set("FAST", 1)), "no error");
}

TEST_P(ProgramTest, LinkErrorsNameBothShaders) {
    const std::string message = compile_error({{"test.frag",
                                                "#version 450 core\nin vec4 missing;\nout vec4 "
                                                "color;\nvoid main() { color = missing; }\n"}},
                                              {});
    EXPECT_EQ(message.rfind("shaders gl/full_screen.vert + test.frag do not link: ", 0), 0u)
        << message;
    EXPECT_NE(message.find("missing"), std::string::npos) << message;
}

constexpr const char* constant_shader =
    "#version 450 core\n"
    "uniform float value;\n"
    "uniform vec3 other;\n"
    "out vec4 color;\n"
    "void main() { color = vec4(value, other); }\n";

glm::vec4 drawn_by(const Program& program) {
    const Framebuffer target(Texture::make_2d(TextureFormat::rgba32f, 1, 1));
    target.bind();
    draw_full_screen(program);
    const std::vector<float> rgba = target.color().read_rgba();
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

TEST_P(ProgramTest, ProgramsOfOneTextAreCompiledOnceAndHaveUniformsOfTheirOwn) {
    const ProgramCache& cache = current_context()->programs();
    const int before = cache.compiled();
    Program first = full_screen_program(constant_shader);
    Program second = full_screen_program(constant_shader);
    EXPECT_EQ(cache.compiled(), before + 1);
    EXPECT_EQ(first.id(), second.id());
    first.set("value", 1.f);
    first.set("other", glm::vec3(2, 3, 4));
    second.set("value", 5.f);
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(drawn_by(first), glm::vec4(1, 2, 3, 4));
        EXPECT_EQ(drawn_by(second), glm::vec4(5, 0, 0, 0));
    }
    first.set("value", 7.f);  // while OpenGL holds the other Program's values
    EXPECT_EQ(drawn_by(first), glm::vec4(7, 2, 3, 4));
    EXPECT_EQ(drawn_by(full_screen_program(constant_shader)), glm::vec4(0));
    EXPECT_EQ(drawn_by(second), glm::vec4(5, 0, 0, 0));
    EXPECT_EQ(cache.compiled(), before + 1);
}

TEST_P(ProgramTest, TheProgramUsedLongestAgoIsForgotten) {
    const ProgramCache& cache = current_context()->programs();
    Program kept = full_screen_program(constant_shader, Defines{}.set("NUMBER", 0));
    kept.set("value", 6.f);
    const int before = cache.compiled();
    const int most = static_cast<int>(ProgramCache::most_programs);
    for (int number = 1; number <= most; ++number) {
        full_screen_program(constant_shader, Defines{}.set("NUMBER", number));
        full_screen_program(constant_shader, Defines{}.set("NUMBER", 1));
    }
    EXPECT_EQ(cache.compiled(), before + most);
    // A Program keeps its linked program even if the cache has dropped it.
    EXPECT_EQ(drawn_by(kept), glm::vec4(6, 0, 0, 0));
    full_screen_program(constant_shader, Defines{}.set("NUMBER", 1));
    EXPECT_EQ(cache.compiled(), before + most);
    full_screen_program(constant_shader, Defines{}.set("NUMBER", 0));
    EXPECT_EQ(cache.compiled(), before + most + 1);
}

}  // namespace
}  // namespace lamina::gl
