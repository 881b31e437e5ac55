// SPDX-License-Identifier: Apache-2.0
#pragma once

struct GladGLContext;  // of <glad/gl.h>
#include <cstdint>
#include <string_view>
#include <utility>

namespace lamina::gl {

// Returns OpenGL's functions of the context that is current in this thread: OSMesa's are not EGL's.
const GladGLContext& api();

// Throws Error if OpenGL has reported an error since the last call. `where` completes "OpenGL: ...
// while ", as "drawing the slabs" does. Does not wait for the GPU.
void check(std::string_view where);

enum class ObjectKind { buffer, texture, vertex_array, framebuffer, query, shader, program };

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
    void release() { id_ = 0; }  // deletes nothing

  private:
    unsigned id_ = 0;
};

// Returns the bytes of buffers and textures that this thread's current context holds now: those
// that were asked for, without the driver's padding. 0 if no context is current.
std::int64_t bytes_allocated();

// Throws Error if a limit on the process's memory (ulimit -v) leaves less than `bytes`. Mesa's
// software renderers crash when they run out of memory, and nothing later could stop them.
void require_memory_left(std::int64_t bytes);

inline constexpr std::int64_t memory_for_context = std::int64_t{1} << 30;
// Bytes that must be left beside what a draw takes itself, once the context exists.
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

}  // namespace lamina::gl
