// SPDX-License-Identifier: Apache-2.0
// A fixture for tests that run with the cpu engine and with OpenGL.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cpu_fixture.h"

namespace lamina {

inline constexpr const char* cpu_engine = "cpu";

class EngineTest : public gl::ContextTest<testing::TestWithParam<const char*>> {
  protected:
    using Base = gl::ContextTest<testing::TestWithParam<const char*>>;

    void SetUp() override {
        const std::string name = GetParam();
        if (name == "egl" && !gl::has_egl()) GTEST_SKIP() << "no libEGL.so.1";
        if (!is_native())
            make_context(name == "egl" ? gl::ContextKind::egl : gl::ContextKind::osmesa);
    }

    bool is_native() const { return std::string(GetParam()) == cpu_engine; }
    Capabilities capabilities() const {
        return is_native() ? cpu_capabilities() : Base::capabilities();
    }
    Image draw(const Volume& volume, const Scene& scene, const OmissionSwitch& omissions = {}) {
        return draw(volume, scene, omissions, capabilities());
    }
    Image draw(const Volume& volume, const Scene& scene, const OmissionSwitch& omissions,
               const Capabilities& capabilities) {
        return is_native() ? render_tiles(volume, scene, omissions, capabilities)
                           : render(volume, scene, capabilities, omissions);
    }
};

// Tests that run with the cpu engine and with OpenGL in software (instantiated in
// cpu_picture_test.cpp).
class BothEngines : public EngineTest {
  protected:
    // Returns the engine's capabilities and, of OpenGL, those of a context that fetches samples.
    std::vector<Capabilities> ways() const {
        std::vector<Capabilities> all{capabilities()};
        if (is_native()) return all;
        all.push_back(capabilities());
        all.back().exact_float_filter = false;
        return all;
    }
};

inline const auto every_engine = testing::Values(cpu_engine, "osmesa", "egl");
inline std::string engine_name(const testing::TestParamInfo<const char*>& info) {
    return info.param;
}

}  // namespace lamina
