#pragma once

#include <godot_cpp/core/defs.hpp>

#include <cmath>
#include <cstdint>

// The engine's plain value types. Their layout is the engine's; their operations are only those in use, since
// heavy geometry belongs to the C++ core.
namespace godot {

#define GODOT_VECTOR_OPERATORS(m_type, m_scalar, m_member)   \
    constexpr m_scalar& operator[](int p_axis) {             \
        return m_member;                                     \
    }                                                        \
    constexpr const m_scalar& operator[](int p_axis) const { \
        return m_member;                                     \
    }                                                        \
    constexpr m_type& operator+=(const m_type& p_b) {        \
        return *this = *this + p_b;                          \
    }                                                        \
    constexpr m_type& operator-=(const m_type& p_b) {        \
        return *this = *this - p_b;                          \
    }                                                        \
    constexpr m_type& operator*=(m_scalar p_b) {             \
        return *this = *this * p_b;                          \
    }                                                        \
    constexpr m_type& operator/=(m_scalar p_b) {             \
        return *this = *this / p_b;                          \
    }                                                        \
    constexpr bool operator==(const m_type&) const = default;

struct Vector2 {
    real_t x = 0, y = 0;

    constexpr Vector2() = default;
    constexpr Vector2(real_t p_x, real_t p_y) : x(p_x), y(p_y) {}
    GODOT_VECTOR_OPERATORS(Vector2, real_t, p_axis == 0 ? x : y)
    constexpr Vector2 operator+(const Vector2& p_b) const { return {x + p_b.x, y + p_b.y}; }
    constexpr Vector2 operator-(const Vector2& p_b) const { return {x - p_b.x, y - p_b.y}; }
    constexpr Vector2 operator*(const Vector2& p_b) const { return {x * p_b.x, y * p_b.y}; }
    constexpr Vector2 operator*(real_t p_b) const { return {x * p_b, y * p_b}; }
    constexpr Vector2 operator/(real_t p_b) const { return {x / p_b, y / p_b}; }
    constexpr Vector2 operator-() const { return {-x, -y}; }
    constexpr real_t dot(const Vector2& p_b) const { return x * p_b.x + y * p_b.y; }
    constexpr real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
};

struct Vector2i {
    int32_t x = 0, y = 0;

    constexpr Vector2i() = default;
    constexpr Vector2i(int32_t p_x, int32_t p_y) : x(p_x), y(p_y) {}
    GODOT_VECTOR_OPERATORS(Vector2i, int32_t, p_axis == 0 ? x : y)
    constexpr Vector2i operator+(const Vector2i& p_b) const { return {x + p_b.x, y + p_b.y}; }
    constexpr Vector2i operator-(const Vector2i& p_b) const { return {x - p_b.x, y - p_b.y}; }
    constexpr Vector2i operator*(int32_t p_b) const { return {x * p_b, y * p_b}; }
    constexpr Vector2i operator/(int32_t p_b) const { return {x / p_b, y / p_b}; }
};

struct Vector3 {
    real_t x = 0, y = 0, z = 0;

    constexpr Vector3() = default;
    constexpr Vector3(real_t p_x, real_t p_y, real_t p_z) : x(p_x), y(p_y), z(p_z) {}
    GODOT_VECTOR_OPERATORS(Vector3, real_t, p_axis == 0 ? x : p_axis == 1 ? y : z)
    constexpr Vector3 operator+(const Vector3& p_b) const { return {x + p_b.x, y + p_b.y, z + p_b.z}; }
    constexpr Vector3 operator-(const Vector3& p_b) const { return {x - p_b.x, y - p_b.y, z - p_b.z}; }
    constexpr Vector3 operator*(const Vector3& p_b) const { return {x * p_b.x, y * p_b.y, z * p_b.z}; }
    constexpr Vector3 operator*(real_t p_b) const { return {x * p_b, y * p_b, z * p_b}; }
    constexpr Vector3 operator/(real_t p_b) const { return {x / p_b, y / p_b, z / p_b}; }
    constexpr Vector3 operator-() const { return {-x, -y, -z}; }
    constexpr real_t dot(const Vector3& p_b) const { return x * p_b.x + y * p_b.y + z * p_b.z; }
    constexpr Vector3 cross(const Vector3& p_b) const {
        return {y * p_b.z - z * p_b.y, z * p_b.x - x * p_b.z, x * p_b.y - y * p_b.x};
    }
    constexpr real_t length_squared() const { return dot(*this); }
    real_t length() const { return std::sqrt(length_squared()); }
    Vector3 normalized() const {
        const real_t l = length();
        return l == 0 ? Vector3() : *this / l;
    }
    real_t distance_to(const Vector3& p_to) const { return (p_to - *this).length(); }
    constexpr Vector3 lerp(const Vector3& p_to, real_t p_weight) const {
        return *this + (p_to - *this) * p_weight;
    }
    bool is_finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(z); }
};

struct Vector3i {
    int32_t x = 0, y = 0, z = 0;

    constexpr Vector3i() = default;
    constexpr Vector3i(int32_t p_x, int32_t p_y, int32_t p_z) : x(p_x), y(p_y), z(p_z) {}
    GODOT_VECTOR_OPERATORS(Vector3i, int32_t, p_axis == 0 ? x : p_axis == 1 ? y : z)
    constexpr Vector3i operator+(const Vector3i& p_b) const { return {x + p_b.x, y + p_b.y, z + p_b.z}; }
    constexpr Vector3i operator-(const Vector3i& p_b) const { return {x - p_b.x, y - p_b.y, z - p_b.z}; }
    constexpr Vector3i operator*(int32_t p_b) const { return {x * p_b, y * p_b, z * p_b}; }
    constexpr Vector3i operator/(int32_t p_b) const { return {x / p_b, y / p_b, z / p_b}; }
};

struct Vector4 {
    real_t x = 0, y = 0, z = 0, w = 0;

    constexpr Vector4() = default;
    constexpr Vector4(real_t p_x, real_t p_y, real_t p_z, real_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    GODOT_VECTOR_OPERATORS(Vector4, real_t, p_axis == 0 ? x : p_axis == 1 ? y : p_axis == 2 ? z : w)
    constexpr Vector4 operator+(const Vector4& p_b) const {
        return {x + p_b.x, y + p_b.y, z + p_b.z, w + p_b.w};
    }
    constexpr Vector4 operator-(const Vector4& p_b) const {
        return {x - p_b.x, y - p_b.y, z - p_b.z, w - p_b.w};
    }
    constexpr Vector4 operator*(real_t p_b) const { return {x * p_b, y * p_b, z * p_b, w * p_b}; }
    constexpr Vector4 operator/(real_t p_b) const { return {x / p_b, y / p_b, z / p_b, w / p_b}; }
};

struct Vector4i {
    int32_t x = 0, y = 0, z = 0, w = 0;

    constexpr Vector4i() = default;
    constexpr Vector4i(int32_t p_x, int32_t p_y, int32_t p_z, int32_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    constexpr bool operator==(const Vector4i&) const = default;
};

#undef GODOT_VECTOR_OPERATORS

struct Rect2 {
    Vector2 position, size;

    constexpr Rect2() = default;
    constexpr Rect2(const Vector2& p_position, const Vector2& p_size) : position(p_position), size(p_size) {}
    constexpr Rect2(real_t p_x, real_t p_y, real_t p_width, real_t p_height)
        : position(p_x, p_y), size(p_width, p_height) {}
    constexpr bool operator==(const Rect2&) const = default;
};

struct Rect2i {
    Vector2i position, size;

    constexpr Rect2i() = default;
    constexpr Rect2i(const Vector2i& p_position, const Vector2i& p_size)
        : position(p_position), size(p_size) {}
    constexpr Rect2i(int32_t p_x, int32_t p_y, int32_t p_width, int32_t p_height)
        : position(p_x, p_y), size(p_width, p_height) {}
    constexpr bool operator==(const Rect2i&) const = default;
};

struct Transform2D {
    Vector2 columns[3] = {{1, 0}, {0, 1}, {0, 0}};

    constexpr bool operator==(const Transform2D&) const = default;
};

struct Plane {
    Vector3 normal;
    real_t d = 0;

    constexpr Plane() = default;
    constexpr Plane(const Vector3& p_normal, real_t p_d) : normal(p_normal), d(p_d) {}
    constexpr real_t distance_to(const Vector3& p_point) const { return normal.dot(p_point) - d; }
    constexpr bool operator==(const Plane&) const = default;
};

struct Quaternion {
    real_t x = 0, y = 0, z = 0, w = 1;

    constexpr Quaternion() = default;
    constexpr Quaternion(real_t p_x, real_t p_y, real_t p_z, real_t p_w) : x(p_x), y(p_y), z(p_z), w(p_w) {}
    constexpr bool operator==(const Quaternion&) const = default;
};

struct AABB {
    Vector3 position, size;

    constexpr AABB() = default;
    constexpr AABB(const Vector3& p_position, const Vector3& p_size) : position(p_position), size(p_size) {}
    constexpr Vector3 get_end() const { return position + size; }
    constexpr Vector3 get_center() const { return position + size * 0.5f; }
    constexpr bool operator==(const AABB&) const = default;
};

struct Basis {
    Vector3 rows[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    constexpr Basis() = default;
    // The images of the three axes.
    constexpr Basis(const Vector3& p_x, const Vector3& p_y, const Vector3& p_z)
        : rows{{p_x.x, p_y.x, p_z.x}, {p_x.y, p_y.y, p_z.y}, {p_x.z, p_y.z, p_z.z}} {}
    constexpr Vector3 get_column(int p_index) const {
        return {rows[0][p_index], rows[1][p_index], rows[2][p_index]};
    }
    constexpr Vector3 xform(const Vector3& p_vector) const {
        return {rows[0].dot(p_vector), rows[1].dot(p_vector), rows[2].dot(p_vector)};
    }
    constexpr Basis operator*(const Basis& p_b) const {
        return {xform(p_b.get_column(0)), xform(p_b.get_column(1)), xform(p_b.get_column(2))};
    }
    constexpr bool operator==(const Basis&) const = default;
};

struct Transform3D {
    Basis basis;
    Vector3 origin;

    constexpr Transform3D() = default;
    constexpr Transform3D(const Basis& p_basis, const Vector3& p_origin = Vector3())
        : basis(p_basis), origin(p_origin) {}
    constexpr Vector3 xform(const Vector3& p_vector) const { return basis.xform(p_vector) + origin; }
    constexpr Transform3D operator*(const Transform3D& p_b) const {
        return {basis * p_b.basis, xform(p_b.origin)};
    }
    constexpr bool operator==(const Transform3D&) const = default;
};

struct Projection {
    Vector4 columns[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

    constexpr bool operator==(const Projection&) const = default;
};

struct Color {
    float r = 0, g = 0, b = 0, a = 1;

    constexpr Color() = default;
    constexpr Color(float p_r, float p_g, float p_b, float p_a = 1) : r(p_r), g(p_g), b(p_b), a(p_a) {}
    constexpr float& operator[](int p_channel) {
        return p_channel == 0 ? r : p_channel == 1 ? g : p_channel == 2 ? b : a;
    }
    constexpr const float& operator[](int p_channel) const {
        return p_channel == 0 ? r : p_channel == 1 ? g : p_channel == 2 ? b : a;
    }
    constexpr Color operator*(float p_b) const { return {r * p_b, g * p_b, b * p_b, a * p_b}; }
    constexpr Color lerp(const Color& p_to, float p_weight) const {
        const float keep = 1 - p_weight;
        return {r * keep + p_to.r * p_weight, g * keep + p_to.g * p_weight, b * keep + p_to.b * p_weight,
                a * keep + p_to.a * p_weight};
    }
    constexpr bool operator==(const Color&) const = default;
};

}  // namespace godot
