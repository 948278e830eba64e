// What GLSL and C++ (with GLM) need in order to read the same file.
//
// A shared header holds, between SHADER_BEGIN and SHADER_END, structs, constants and functions in the common
// subset of both languages: float literals end in f, no swizzles (v.x, v.y one at a time), no vector
// constructors that mix implicit conversions, SHADER_OUT(vec3) for out parameters. In C++ all of it lies in
// namespace ridgeline::shaders.
//
// Structs for blocks hold vec4, ivec4, uvec4, mat4, vec2 at multiples of 8, and scalars, and fill whole
// multiples of 16 bytes: then std140, std430 and C++ agree on every offset, which SHADER_STRUCT_SIZE and
// SHADER_OFFSET assert. A block has such a struct as its only member:
//
//     layout(std140, binding = 0) uniform FrameBlock { FrameUniforms frame; };
#pragma once

#ifdef __cplusplus

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace ridgeline::shaders {
using namespace glm;
using uint = std::uint32_t;
}  // namespace ridgeline::shaders

#define SHADER_BEGIN namespace ridgeline::shaders {
#define SHADER_END }
#define SHADER_FUNCTION inline
#define SHADER_CONSTANT inline constexpr
#define SHADER_OUT(type) type&
#define SHADER_INOUT(type) type&
// GLSL may reorder and fuse what is not precise; C++ is built with -ffp-contract=off.
#define SHADER_PRECISE
#define SHADER_STRUCT_SIZE(type, size_bytes) \
    static_assert(sizeof(type) == (size_bytes) && (size_bytes) % 16 == 0);
#define SHADER_OFFSET(type, field, offset_bytes) static_assert(offsetof(type, field) == (offset_bytes));

#else

#define SHADER_BEGIN
#define SHADER_END
#define SHADER_FUNCTION
#define SHADER_CONSTANT const
#define SHADER_OUT(type) out type
#define SHADER_INOUT(type) inout type
#define SHADER_PRECISE precise
#define SHADER_STRUCT_SIZE(type, size_bytes)
#define SHADER_OFFSET(type, field, offset_bytes)

#endif
