// SPDX-License-Identifier: Apache-2.0
// One kernel as a fragment and as a compute shader: shows what a GPU gains if pictures are computed
// without its rasteriser. A GPU made for computing lets few of its processors run fragments.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gl/framebuffer.h"
#include "gl/sync.h"
#include "gl/texture.h"
#include "gl/timeline.h"

namespace lamina::selftest {

// Work of the kernel (shaders/study/probe.glsl, in its order): cubics of cells in registers, or the
// eight corners of cells along rays, from a 3D texture, a 2D texture or a buffer.
enum class ProbeKernel { arithmetic, texels, gathers, words };
const char* name_of(ProbeKernel kernel);

struct ProbeWay {
    ProbeKernel kernel;
    int group = 0;        // invocations in a workgroup of the compute shader; 0: a fragment shader
    bool morton = false;  // order of the pixels; else rows
};

// Returns all ways. Those of a kernel follow one another, and its fragment shader is the first.
std::vector<ProbeWay> probe_ways();

struct ProbeResult {
    std::vector<float> values;  // one for each pixel, from the lowest row on
    // Medians of several runs: by OpenGL's clock, if the context has one, and by the host's from
    // the call until the result is there.
    std::optional<double> opengl_ms;
    double wall_ms = 0;
};

// Runs the ways for pictures of one size. Needs a current context.
class ShaderProbe {
  public:
    static constexpr int edge = 256;        // samples of the volume along each axis
    static constexpr int rounds = 256;      // of each pixel's work
    static std::uint8_t sample(int index);  // a sample of the volume, x fastest
    // Change of a ray's first place from pixel to pixel, in 2^-12 voxels, across `pixels` pixels:
    // rays also move by up to 44 voxels sideways, and all stay in the volume.
    static int pixel_step(int pixels) { return 208 * 4096 / pixels; }

    ShaderProbe(int width, int height);

    // Runs a way for a tenth of a second, which wakes the GPU, and then `timed` times.
    ProbeResult run(const ProbeWay& way, int timed);

  private:
    gl::Program program_of(const ProbeWay& way) const;
    void draw(const gl::Program& program, const ProbeWay& way);
    std::vector<float> values_of(const ProbeWay& way) const;

    int width_, height_;
    gl::Texture volume_, slices_;
    gl::Buffer words_, results_;
    gl::Framebuffer target_;
    gl::VertexArray any_;
    gl::Timeline timeline_;
};

// Runs all ways. Returns {width, height, rounds, ways: [{kernel, shader, group, order, opengl_ms,
// wall_ms, times_as_fast, same_values}]}; the last two compare a way with the kernel's fragment
// shader.
nlohmann::ordered_json probe_json(int width, int height);
// Returns the ways of a probe_json() as a table with a line each.
std::string probe_table(const nlohmann::ordered_json& probe);

}  // namespace lamina::selftest
