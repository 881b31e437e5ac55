// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

struct GladGLContext;  // of <glad/gl.h>

namespace lamina::gl {

// Returns the OpenGL functions of this thread's context: those of OSMesa are not those of EGL.
const GladGLContext& api();

// Throws Error if OpenGL has reported an error since the last call. `where` completes "OpenGL: ...
// while ", as "drawing the slabs" does. Does not wait for the GPU.
void check(std::string_view where);

// Returns the value of an integer parameter of OpenGL, such as GL_MAX_TEXTURE_SIZE.
int integer(unsigned name);

// Kinds of OpenGL objects that a Handle may own.
enum class ObjectKind { buffer, vertex_array, framebuffer, texture, query, shader, program };

unsigned new_object(ObjectKind kind);  // `kind`: a buffer, vertex array or framebuffer
void delete_object(ObjectKind kind, unsigned id);

// Owns one OpenGL object and deletes it in the destructor. Move-only; 0 owns nothing.
template <ObjectKind kind>
class Handle {
  public:
    Handle() = default;
    explicit Handle(unsigned id) : id_(id) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    ~Handle() {
        if (id_) delete_object(kind, id_);
    }

    unsigned id() const { return id_; }
    void release() { id_ = 0; }  // forgets the object without deleting it

  private:
    unsigned id_ = 0;
};

// Returns the bytes of the current context's buffers and textures, unpadded; 0 without context.
std::int64_t bytes_allocated();

// Throws Error if a limit on the process's memory (ulimit -v) leaves less than `bytes`. Mesa's
// software renderers crash when they run out of memory, which no later check could prevent.
void require_memory_left(std::int64_t bytes);

// Bytes that must be free before a context is made (require_memory_left()).
inline constexpr std::int64_t memory_for_context = std::int64_t{1} << 30;
// Bytes that must be free, beside lamina's own, for a draw: the driver takes memory as it draws.
inline constexpr std::int64_t memory_for_drawing = std::int64_t{1} << 28;

// The contribution of one object to bytes_allocated() during its lifetime.
class AllocatedBytes {
  public:
    AllocatedBytes() = default;
    explicit AllocatedBytes(std::int64_t count);
    AllocatedBytes(AllocatedBytes&& other) noexcept : count_(std::exchange(other.count_, 0)) {}
    AllocatedBytes& operator=(AllocatedBytes&& other) noexcept {
        std::swap(count_, other.count_);
        return *this;
    }
    ~AllocatedBytes();

    std::int64_t count() const { return count_; }

  private:
    std::int64_t count_ = 0;
};

// A function that was found at run time, as a pointer of whatever type it is assigned to.
struct AnyFunction {
    void* address;

    template <typename Function>
    operator Function*() const {
        return reinterpret_cast<Function*>(address);
    }
};

// A library loaded at run time, never unloaded: Mesa and LLVM leave threads and exit handlers.
class SharedLibrary {
  public:
    // Loads the first of `names` that can be loaded. Throws Error, which says why each could not.
    explicit SharedLibrary(std::initializer_list<const char*> names);

    static bool is_loaded(const char* name);

    // Returns the function `name`. Throws Error, which names the library, if it has none.
    AnyFunction function(const char* name) const;

  private:
    std::string name_;
    void* handle_ = nullptr;
};

// GPU memory of fixed size for vertices, indices or storage blocks; undefined until written.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::size_t byte_count);
    // Makes a buffer that stays mapped: a draw sees what was written through mapped() before it.
    // The writer must not change data that a draw still reads (see Fence).
    static Buffer make_mapped(std::size_t byte_count);
    // Makes a buffer in the host's memory that stays mapped for reading (see ReadBack).
    static Buffer make_host(std::size_t byte_count);
    // Makes a buffer that shaders write and the host reads: in software one that stays mapped, as
    // OpenGL's memory is the host's there.
    static Buffer make_readable(std::size_t byte_count);

    template <typename T, std::size_t extent>
    explicit Buffer(std::span<T, extent> elements) : Buffer(elements.size_bytes()) {
        write(elements);
    }

    // Replaces the bytes from `byte_offset` on by `elements`, which must fit.
    template <typename T, std::size_t extent>
    void write(std::span<T, extent> elements, std::size_t byte_offset = 0) {
        static_assert(std::is_trivially_copyable_v<T>);
        write_bytes(std::as_bytes(elements), byte_offset);
    }

    // Waits for the GPU and fills `elements` with the bytes from `byte_offset` on, which must
    // exist. ReadBack is quicker for what each frame reads.
    template <typename T, std::size_t extent>
    void read(std::span<T, extent> elements, std::size_t byte_offset = 0) const {
        static_assert(std::is_trivially_copyable_v<T>);
        read_bytes(std::as_writable_bytes(elements), byte_offset);
    }
    void clear();  // sets all bytes to 0

    // Binds the buffer to the storage block that shaders declare with `binding`.
    void bind_storage(unsigned binding) const;
    // Binds a part alone, which must begin at a multiple of 256 bytes.
    void bind_storage(unsigned binding, std::size_t byte_offset, std::size_t byte_count) const;

    // Returns the mapped memory, which is slow to read if it is mapped for writing; null if the
    // buffer is not mapped.
    std::byte* mapped() const { return mapped_; }

    unsigned id() const { return handle_.id(); }
    std::size_t byte_count() const { return static_cast<std::size_t>(bytes_.count()); }

  private:
    Buffer(std::size_t byte_count, unsigned storage_flags);
    static Buffer make_mapped(std::size_t byte_count, unsigned access, unsigned storage_flags);
    void write_bytes(std::span<const std::byte> bytes, std::size_t byte_offset);
    void read_bytes(std::span<std::byte> bytes, std::size_t byte_offset) const;

    Handle<ObjectKind::buffer> handle_;
    AllocatedBytes bytes_;
    std::byte* mapped_ = nullptr;
};

// The sources of vertex attributes, if any, and indices. The buffers must outlive the draws.
class VertexArray {
  public:
    VertexArray();

    // Set the source of attribute `location`: `components` floats (or ints) per vertex, the first
    // at `byte_offset`, those of the next vertex `byte_stride` further on.
    void set_floats(unsigned location, const Buffer& buffer, int components,
                    std::size_t byte_stride, std::size_t byte_offset);
    void set_integers(unsigned location, const Buffer& buffer, int components,
                      std::size_t byte_stride, std::size_t byte_offset);
    void set_indices(const Buffer& buffer);  // 32-bit unsigned

    void bind() const;
    unsigned id() const { return handle_.id(); }

  private:
    void set_source(unsigned location, const Buffer& buffer, std::size_t byte_stride,
                    std::size_t byte_offset);

    Handle<ObjectKind::vertex_array> handle_;
};

}  // namespace lamina::gl
