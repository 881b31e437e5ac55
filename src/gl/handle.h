// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

namespace lamina::gl {

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

}  // namespace lamina::gl
