// SPDX-License-Identifier: Apache-2.0
// Fixtures for tests that draw. Every test gets a context of its own, and must free all GPU memory.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "gl/api.h"
#include "gl/context.h"
#include "gl/program.h"

namespace lamina::gl {

inline bool has_egl() {
    return dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL) != nullptr;
}

// A test with a context of its own; `Base` is testing::Test or a parameterised one.
template <typename Base>
class ContextTest : public Base {
  protected:
    void make_context(ContextKind kind) {
        context_ = Context::create(kind);
        current_.emplace(*context_);
    }
    void TearDown() override { EXPECT_EQ(bytes_allocated(), 0); }

    const Capabilities& capabilities() const { return context_->capabilities(); }

  private:
    std::unique_ptr<Context> context_;
    std::optional<CurrentContext> current_;
};

// A test with an OSMesa context, which draws the same on every machine.
class GlTest : public ContextTest<testing::Test> {
  protected:
    void SetUp() override { make_context(ContextKind::osmesa); }
};

// A test for INSTANTIATE_TEST_SUITE_P(..., both_contexts, context_name): once with OSMesa, once
// with EGL if the machine has it.
class EveryContextTest : public ContextTest<testing::TestWithParam<ContextKind>> {
  protected:
    void SetUp() override {
        if (GetParam() == ContextKind::egl && !has_egl()) GTEST_SKIP() << "no libEGL.so.1";
        make_context(GetParam());
    }
};

inline const auto both_contexts = testing::Values(ContextKind::osmesa, ContextKind::egl);

inline std::string context_name(const testing::TestParamInfo<ContextKind>& info) {
    return info.param == ContextKind::osmesa ? "osmesa" : "egl";
}

// Returns a finder that finds the shaders of a test, by name, before those of shaders/.
inline ShaderFinder with_shaders(std::map<std::string, std::string> texts) {
    return [texts = std::move(texts)](const std::string& name) -> std::optional<std::string> {
        const auto found = texts.find(name);
        return found != texts.end() ? found->second : find_shader(name);
    };
}

// Returns a program for draw_full_screen() that runs `fragment`, the text of a fragment shader, for
// every pixel.
inline Program full_screen_program(const std::string& fragment, const Defines& defines = {}) {
    return Program(ShaderSources{
        compose_shader("gl/full_screen.vert"),
        compose_shader("test.frag", defines, with_shaders({{"test.frag", fragment}}))});
}

// Returns a program that runs `compute`, the text of a compute shader.
inline Program compute_program(const std::string& compute, const Defines& defines = {}) {
    return Program(ShaderSources{
        compose_shader("test.comp", defines, with_shaders({{"test.comp", compute}}))});
}

}  // namespace lamina::gl
