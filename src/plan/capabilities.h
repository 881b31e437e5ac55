// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace lamina {

// What will draw can do: data for the plan, filled by gl::Context, or by tile_capabilities() for
// the native engine.
struct Capabilities {
    std::string renderer;  // GL_RENDERER, with how the context was made: "OSMesa: llvmpipe (...)"
    int threads = 0;       // that the native engine takes: they change no picture
    bool software = true;  // no GPU behind it
    bool tiles = false;    // the native engine: no OpenGL
    int max_texture_size = 0;        // GL_MAX_TEXTURE_SIZE, also of the render target
    int max_3d_texture_size = 0;     // GL_MAX_3D_TEXTURE_SIZE
    int max_array_layers = 0;        // GL_MAX_ARRAY_TEXTURE_LAYERS
    int subpixel_bits = 8;           // GL_SUBPIXEL_BITS: of the grid that corners are rounded to
    bool framebuffer_fetch = false;  // GL_EXT_shader_framebuffer_fetch
    // GL's own limits mislead (docs/numerics.md, section 2).
    std::uint64_t max_texture_bytes = std::uint64_t{1} << 30;
    bool exact_float_filter =
        false;  // measured: linear filtering of R32F is good to 1e-6 (llvmpipe; not GPUs)
    // Where that is not: whether filters of R8, R16 and R32F were measured to be as good as weights
    // rounded to 8 bits, which slab trials have.
    bool eight_bit_filter = false;
};

// For reports of times: the renderer, and its threads where they are known.
inline std::string renderer_and_threads(const Capabilities& capabilities) {
    if (capabilities.threads == 0) return capabilities.renderer;
    return capabilities.renderer + ", " + std::to_string(capabilities.threads) +
           (capabilities.threads == 1 ? " thread" : " threads");
}

}  // namespace lamina
