// SPDX-License-Identifier: Apache-2.0
#include "gl/timeline.h"

#include <glad/gl.h>

#include "gl/api.h"
#include "gl/framebuffer.h"
#include "gl_fixture.h"

namespace lamina::gl {
namespace {

using QueryTest = EveryContextTest;
INSTANTIATE_TEST_SUITE_P(Contexts, QueryTest, both_contexts, context_name);

TEST_P(QueryTest, CountsFragmentsExactly) {
    const Framebuffer target(Texture::make_2d(TextureFormat::rgba8, 61, 43));
    target.bind();
    // Discarded fragments are not counted; the columns 0, 3, ..., 60 remain.
    const Program all = full_screen_program(
        "#version 450 core\nout vec4 color;\nvoid main() { color = vec4(1); }\n");
    const Program thirds = full_screen_program(R"(#version 450 core
        out vec4 color;
        void main() { if (int(gl_FragCoord.x) % 3 != 0) discard; color = vec4(1); }
    )");
    Query query(Query::Kind::samples_passed);
    query.begin();
    draw_full_screen(all);
    draw_full_screen(all);
    query.end();
    EXPECT_EQ(query.result(), 2u * 61 * 43);

    query.begin();
    draw_full_screen(thirds);
    query.end();
    EXPECT_EQ(query.result(), 21u * 43);
}

TEST_P(QueryTest, MeasuresTime) {
    const Framebuffer target(Texture::make_2d(TextureFormat::rgba8, 256, 256));
    target.bind();
    const Program program = full_screen_program(
        "#version 450 core\nout vec4 color;\nvoid main() { color = vec4(1); }\n");
    Query before(Query::Kind::timestamp), after(Query::Kind::timestamp);
    before.stamp();
    api().Flush();
    draw_full_screen(program);
    after.stamp();
    EXPECT_GT(before.result(), 0u);
    EXPECT_GT(after.result(), before.result());
}

}  // namespace
}  // namespace lamina::gl
