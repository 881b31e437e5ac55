// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace lamina {

// How compute shaders draw rays. Pictures do not depend on it.
struct RayDispatch {
    int group = 64;  // rays of a workgroup: 32, 64 or 128 (shaders/gl/tile.glsl)
    // True: workgroups take tiles from a queue (shaders/gl/march.glsl). For GPUs, because software
    // ends all loops of an invocation together, however many tiles it draws.
    bool queue = false;
    // True: tables of transfer functions and meshes are storage blocks, not textures. Nobody has
    // measured on a GPU yet which is faster.
    bool blocks = false;
    // True: tiles of volumes are drawn in the order of what they took in the last frame, the
    // longest first (slicing/gl_march.h). Whether that gains more than it takes is a guess, too.
    bool sorted = false;
    // True: a ray cuts a cell at once, and does not wait until its group cuts some; also in
    // fragment shaders (shaders/slicing/exact_segment.glsl).
    bool alone = false;

    friend bool operator==(const RayDispatch&, const RayDispatch&) = default;
};

// Abilities and limits of an OpenGL context (gl::Context) or the cpu engine (cpu_capabilities()).
struct Capabilities {
    std::string renderer;  // GL_RENDERER, with how the context was made: "OSMesa: llvmpipe (...)"
    int threads = 0;       // of the cpu engine; they do not change the picture
    bool software = true;  // no GPU behind it
    bool cpu = false;      // the cpu engine, not OpenGL
    int max_texture_size = 0;     // GL_MAX_TEXTURE_SIZE, also of the render target
    int max_3d_texture_size = 0;  // GL_MAX_3D_TEXTURE_SIZE
    std::int64_t max_storage_bytes = std::int64_t{1} << 27;  // GL_MAX_SHADER_STORAGE_BLOCK_SIZE
    int max_buffer_texels = 0;  // GL_MAX_TEXTURE_BUFFER_SIZE; 0: no compute shaders
    RayDispatch rays;
    // True: cells are read from words of storage buffers, which takes less time than texels on
    // llvmpipe; on GPUs nobody has measured it yet. None: in software.
    std::optional<bool> sample_words;
    int subpixel_bits = 8;  // GL_SUBPIXEL_BITS: corners are rounded to a grid this fine
    // Largest texture that is made; larger volumes are cut into bricks. OpenGL reports no such
    // limit (docs/numerics.md, section 2): 1 GiB in software and on GPUs of unknown memory.
    std::uint64_t max_texture_bytes = std::uint64_t{1} << 30;
    // Measured: linear filtering of R32F has errors below 1e-6 (true on llvmpipe, not on GPUs).
    bool exact_float_filter = false;
    // Measured: the filters of R8, R16 and R32F are as good as weights rounded to 8 bits, which
    // trials of filters assume. It matters only if exact_float_filter is false.
    bool eight_bit_filter = false;
};

// Returns max_texture_bytes for a GPU with so many bytes of memory; 0: unknown. A lit volume has
// two large textures, samples and gradients, and pictures and tables need room beside them, so that
// one texture takes at most a quarter.
inline std::uint64_t max_texture_bytes_of(std::uint64_t memory_bytes) {
    return std::max(Capabilities{}.max_texture_bytes, memory_bytes / 4);
}

// Returns the renderer, and its number of threads if that is known, for reports of times.
inline std::string renderer_and_threads(const Capabilities& capabilities) {
    if (capabilities.threads == 0) return capabilities.renderer;
    return capabilities.renderer + ", " + std::to_string(capabilities.threads) +
           (capabilities.threads == 1 ? " thread" : " threads");
}

}  // namespace lamina
