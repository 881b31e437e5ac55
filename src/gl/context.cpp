// SPDX-License-Identifier: Apache-2.0
#include "gl/context.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>
#include <glad/gl.h>
#include "base/enum_words.h"
#include "base/error.h"
#include "gl/framebuffer.h"

namespace lamina::gl {

bool has_extension(std::string_view name) {
    for (int i = 0; i < integer(GL_NUM_EXTENSIONS); ++i) {
        if (name == reinterpret_cast<const char*>(
                        api().GetStringi(GL_EXTENSIONS, static_cast<unsigned>(i))))
            return true;
    }
    return false;
}

namespace {

int largest_render_target() {
    GLint viewport[2] = {0, 0};
    api().GetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return std::min({integer(GL_MAX_TEXTURE_SIZE), integer(GL_MAX_FRAMEBUFFER_WIDTH),
                     integer(GL_MAX_FRAMEBUFFER_HEIGHT), viewport[0], viewport[1]});
}

// Returns the bytes of the GPU's memory; 0 if the driver does not tell. NVIDIA's drivers do, and
// Mesa's of AMD's GPUs.
std::uint64_t gpu_memory() {
    constexpr GLenum total_kib = 0x9048;  // GPU_MEMORY_INFO_TOTAL_AVAILABLE_MEMORY_NVX
    if (!has_extension("GL_NVX_gpu_memory_info")) return 0;
    return std::uint64_t{1024} * static_cast<std::uint64_t>(std::max(integer(total_kib), 0));
}

// Recognises a software renderer by its name: EGL may list it as a hardware device.
bool is_software_renderer(const std::string& renderer) {
    return renderer.find("llvmpipe") != std::string::npos ||
           renderer.find("softpipe") != std::string::npos;
}

const char* advice(ContextKind kind) {
    switch (kind) {
        case ContextKind::osmesa:
            return "install libosmesa6, or pass --context egl";
        case ContextKind::gpu:
            return "install the GPU's own driver and libegl1, or do without it: --context cpu";
        case ContextKind::egl:
            return "install libegl1 and libegl-mesa0 or the GPU's own driver, or pass --context "
                   "osmesa";
        case ContextKind::any:
            return "install libosmesa6, or libegl1 with libegl-mesa0 or the GPU's own driver";
    }
    unreachable_enum();
}

// Throws Error if the context has too few storage blocks for tables. shaders/projection/walk.comp
// has the most; fragment shaders have the intervals of the transfer function alone.
void require_blocks(const std::string& renderer) {
    struct Limit {
        const char* what;
        int needed;
        GLenum name;
    };
    constexpr Limit limits[]{
        {"storage blocks in a compute shader", 9, GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS},
        {"storage blocks in a fragment shader", 1, GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS},
        {"bindings of storage blocks", 10, GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS}};
    for (const auto& [what, needed, name] : limits) {
        if (const int most = integer(name); most < needed)
            fail("LAMINA_RAYS: blocks needs {} {}, found {}: {}", needed, what, most, renderer);
    }
}

// Sets how rays are marched, from the words of the environment variable LAMINA_RAYS, with which
// tools/gpu_check compares the ways (docs/gpu.md).
void set_rays(Capabilities& capabilities) {
    const char* const words = std::getenv("LAMINA_RAYS");
    std::istringstream all(words != nullptr ? words : "");
    for (std::string word; std::getline(all, word, ',');) {
        if (word == "words" || word == "texels") {
            capabilities.sample_words = word == "words";
        } else if (word == "32" || word == "64" || word == "128") {
            capabilities.rays.group = std::stoi(word);
        } else if (word == "queue") {
            if (capabilities.software)
                fail("LAMINA_RAYS: queue is for GPUs, because software ends long loops: {}",
                     capabilities.renderer);
            capabilities.rays.queue = true;
        } else if (word == "blocks") {
            require_blocks(capabilities.renderer);
            capabilities.rays.blocks = true;
        } else if (word == "sorted") {
            if (!has_extension("GL_ARB_shader_clock"))
                fail("LAMINA_RAYS: sorted needs GL_ARB_shader_clock: {}", capabilities.renderer);
            capabilities.rays.sorted = true;
        } else if (word == "alone") {
            capabilities.rays.alone = true;
        } else {
            fail(
                "LAMINA_RAYS: found {}, expected words, texels, 32, 64, 128, queue, blocks, sorted "
                "or alone",
                word);
        }
    }
}

thread_local Context* current_of_thread = nullptr;

}  // namespace

std::unique_ptr<Context> Context::create(ContextKind kind) {
    using Attempt = std::function<std::unique_ptr<Context>()>;
    require_memory_left(memory_for_context);
    const Attempt hardware = [] { return create_egl_context(EglDevices::hardware); };
    const Attempt egl = [] { return create_egl_context(EglDevices::any); };
    const Attempt osmesa = create_osmesa_context;

    std::vector<Attempt> attempts{hardware, osmesa, egl};
    if (kind == ContextKind::gpu) attempts = {hardware};
    if (kind == ContextKind::osmesa) attempts = {osmesa};
    if (kind == ContextKind::egl) attempts = {egl};

    std::vector<std::string> reasons;
    for (const Attempt& attempt : attempts) {
        std::unique_ptr<Context> made;
        try {
            made = attempt();
        } catch (const Error& error) {
            const std::string reason = error.what();
            if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end())
                reasons.push_back(reason);
            continue;
        }
        const CurrentContext current(*made);
        set_rays(made->capabilities_);
        return made;
    }
    fail("no OpenGL 4.5 core context ({}): {}", fmt::join(reasons, "; "), advice(kind));
}

Context::Context() : functions_(std::make_unique<GladGLContext>()) {}

Context::~Context() {
    assert(scopes_ == 0);
}

void Context::initialise(LoadFunction load, const char* interface_name, bool software) {
    const CurrentContext current(*this);
    const int version = gladLoadGLContext(functions_.get(), load);
    const int major = GLAD_VERSION_MAJOR(version);
    const int minor = GLAD_VERSION_MINOR(version);
    if (major < 4 || (major == 4 && minor < 5))
        fail("{}: the context has OpenGL {}.{}, 4.5 is needed", interface_name, major, minor);
    const std::string renderer = reinterpret_cast<const char*>(api().GetString(GL_RENDERER));
    capabilities_.renderer = std::string(interface_name) + ": " + renderer;
    capabilities_.software = software || is_software_renderer(renderer);
    capabilities_.max_texture_size = largest_render_target();
    capabilities_.max_storage_bytes = integer(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    capabilities_.subpixel_bits = integer(GL_SUBPIXEL_BITS);
    capabilities_.max_3d_texture_size = integer(GL_MAX_3D_TEXTURE_SIZE);
    capabilities_.max_buffer_texels = integer(GL_MAX_TEXTURE_BUFFER_SIZE);
    if (!capabilities_.software)
        capabilities_.max_texture_bytes = max_texture_bytes_of(gpu_memory());

    // The log keeps only errors, for check(). Dithering would change codes of fixed-point targets.
    api().Enable(GL_DEBUG_OUTPUT);
    api().DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    api().DebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    api().Disable(GL_DITHER);
    api().PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    api().PixelStorei(GL_PACK_ALIGNMENT, 1);
    check("setting up the context");

    const FilterError floats = measure_filter_error(TextureFormat::r32f);
    capabilities_.exact_float_filter = floats.found <= 1e-6;
    if (capabilities_.exact_float_filter) return;
    capabilities_.eight_bit_filter =
        floats.as_good_as_eight_bits() &&
        measure_filter_error(TextureFormat::r16).as_good_as_eight_bits() &&
        measure_filter_error(TextureFormat::r8).as_good_as_eight_bits();
}

Context* current_context() {
    return current_of_thread;
}

const GladGLContext& api() {
    assert(current_of_thread != nullptr);
    return *current_of_thread->functions_;
}

CurrentContext::CurrentContext(Context& context) : context_(context), before_(current_of_thread) {
    std::thread::id owner;
    const std::thread::id self = std::this_thread::get_id();
    if (!context_.thread_.compare_exchange_strong(owner, self) && owner != self)
        fail("OpenGL: this context is current in another thread");
    ++context_.scopes_;
    if (before_ == &context_) return;
    try {
        take();
    } catch (const Error&) {
        give_back();
        throw;
    }
    current_of_thread = &context_;
}

// Releases EGL's context first: in Mesa, EGL and OSMesa share one current context, and OSMesa would
// take a context of EGL for one of its own.
void CurrentContext::take() {
    egl_ = release_egl();
    osmesa_ = release_osmesa();
    context_.bind();
}

CurrentContext::~CurrentContext() {
    assert(current_of_thread == &context_);
    if (before_ != &context_) context_.release();
    current_of_thread = before_;
    give_back();
}

void CurrentContext::give_back() const {
    restore(osmesa_);
    restore(egl_);
    if (--context_.scopes_ == 0) context_.thread_ = std::thread::id();
}

}  // namespace lamina::gl
