#pragma once

#include <godot_cpp/core/interface.hpp>
#include <godot_cpp/variant/math_types.hpp>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace godot {

class Object;
class Variant;

template <typename T>
class TypedArray;

template <typename T>
struct BitField {
    int64_t value = 0;

    constexpr BitField() = default;
    constexpr BitField(int64_t p_value) : value(p_value) {}
    constexpr BitField(T p_value) : value(int64_t(p_value)) {}
    constexpr operator int64_t() const { return value; }
    constexpr bool has_flag(T p_flag) const { return (value & int64_t(p_flag)) != 0; }
    constexpr void set_flag(T p_flag) { value |= int64_t(p_flag); }
    constexpr void clear_flag(T p_flag) { value &= ~int64_t(p_flag); }
};

}  // namespace godot

#include <godot_cpp/variant/builtin_declarations.hpp>

namespace godot {

// Any value of the engine. All conversions follow the engine's own rules.
class Variant {
    alignas(8) uint8_t opaque[24];

    Variant(int p_type, const void* p_value);
    void convert(int p_type, void* r_value) const;
    template <typename T>
    T converted(int p_type) const;

  public:
#include <godot_cpp/variant/variant_enums.inc>

    Variant();
    Variant(std::nullptr_t) : Variant() {}
    Variant(const Variant& p_other);
    Variant(Variant&& p_other) noexcept;
    ~Variant();
    Variant& operator=(const Variant& p_other);
    Variant& operator=(Variant&& p_other) noexcept;

    Variant(bool p_value);
    Variant(int64_t p_value);
    Variant(int32_t p_value) : Variant(int64_t(p_value)) {}
    Variant(uint32_t p_value) : Variant(int64_t(p_value)) {}
    Variant(uint64_t p_value) : Variant(int64_t(p_value)) {}
    Variant(double p_value);
    Variant(float p_value) : Variant(double(p_value)) {}
    Variant(const char* p_value);
    Variant(const Object* p_value);
    template <typename T>
    Variant(const BitField<T>& p_value) : Variant(p_value.value) {}

    operator bool() const;
    operator int64_t() const;
    operator int32_t() const {
        return int32_t(operator int64_t());
    }
    operator uint32_t() const {
        return uint32_t(operator int64_t());
    }
    operator uint64_t() const {
        return uint64_t(operator int64_t());
    }
    operator double() const;
    operator float() const {
        return float(operator double());
    }
    operator Object*() const {
        return get_validated_object();
    }

// Qualified, because Variant has constants called AABB and RID.
#define GODOT_VARIANT_CONVERSION(m_type, m_enum) \
    Variant(const ::godot::m_type& p_value);     \
    operator ::godot::m_type() const;
    GODOT_BUILTIN_TYPES(GODOT_VARIANT_CONVERSION)
#undef GODOT_VARIANT_CONVERSION

    // Null when it holds no object, or one that is gone.
    Object* get_validated_object() const;

    Type get_type() const;
    static String get_type_name(Type p_type);
    static bool can_convert_strict(Type p_from, Type p_to);
    String stringify() const;
    bool booleanize() const;
    uint32_t hash() const;
    void clear();

    Variant get(const Variant& p_key, bool* r_valid = nullptr) const;
    void set(const Variant& p_key, const Variant& p_value, bool* r_valid = nullptr);
    void callp(const StringName& p_method, const Variant** p_args, int p_count, Variant& r_return,
               GDExtensionCallError& r_error);
    template <typename... Args>
    Variant call(const StringName& p_method, const Args&... p_args);
    static void evaluate(Operator p_operator, const Variant& p_a, const Variant& p_b, Variant& r_return,
                         bool& r_valid);

    bool operator==(const Variant& p_other) const;
    bool operator!=(const Variant& p_other) const {
        return !(*this == p_other);
    }
    bool operator<(const Variant& p_other) const;

    void* _native_ptr() {
        return opaque;
    }
    const void* _native_ptr() const {
        return opaque;
    }
};

namespace internal {

// The arguments of a call that takes any number of them: as Variants, and pointers to these.
template <size_t N>
struct VariantArguments {
    std::array<Variant, N> values;
    std::array<const Variant*, N + 1> pointers;  // One more, so that it is never empty.

    template <typename... Args>
    explicit VariantArguments(const Args&... p_args) : values{Variant(p_args)...} {
        for (size_t i = 0; i < N; i++) {
            pointers[i] = &values[i];
        }
        pointers[N] = nullptr;
    }
};

template <typename... Args>
VariantArguments(const Args&...) -> VariantArguments<sizeof...(Args)>;

}  // namespace internal

template <typename... Args>
Variant Variant::call(const StringName& p_method, const Args&... p_args) {
    internal::VariantArguments args(p_args...);
    Variant ret;
    GDExtensionCallError error;
    callp(p_method, args.pointers.data(), int(sizeof...(Args)), ret, error);
    return ret;
}

// Bytes of a string in some encoding, ended by a zero that length() does not count.
class CharString {
    std::string bytes;

  public:
    CharString() = default;
    explicit CharString(std::string p_bytes) : bytes(std::move(p_bytes)) {}
    const char* get_data() const { return bytes.c_str(); }
    const char* ptr() const { return bytes.c_str(); }
    int64_t length() const { return int64_t(bytes.size()); }
};

}  // namespace godot

#include <godot_cpp/variant/builtin_classes.hpp>

namespace godot {

inline String operator+(const char* p_left, const String& p_right) {
    return String(p_left) + p_right;
}
inline String itos(int64_t p_value) {
    return String::num_int64(p_value);
}
inline String rtos(double p_value) {
    return String::num(p_value);
}

// `p_text` with its %s, %d, %f… replaced, as GDScript's % operator does.
template <typename... Args>
String vformat(const String& p_text, const Args&... p_args) {
    Array values;
    (values.push_back(Variant(p_args)), ...);
    return p_text % values;
}

}  // namespace godot
