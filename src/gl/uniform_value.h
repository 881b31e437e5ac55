// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamina::gl {

enum class UniformKind {
    float1,
    float2,
    float3,
    float4,
    double1,
    double2,
    double3,
    double4,
    int1,
    int2,
    int3,
    matrix4
};

// What a uniform holds: one value, or those of an array.
class UniformValue {
  public:
    UniformValue() = default;
    // Copies `count` values.
    void assign(UniformKind kind, int count, const void* data);
    void clear();  // to 0

    friend void upload(unsigned program, int location, const UniformValue& value);

  private:
    UniformKind kind_ = UniformKind::float1;
    int count_ = 0;
    std::vector<std::byte> bytes_;
};

void upload(unsigned program, int location, const UniformValue& value);

}  // namespace lamina::gl
