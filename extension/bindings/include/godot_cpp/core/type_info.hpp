#pragma once

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/core/property_info.hpp>

#include <concepts>
#include <type_traits>

// How C++ types look to the engine: as a Variant, behind the pointers of a direct call, and in a method's
// description.
namespace godot::internal {

template <typename T>
struct EnumName;  // Made by VARIANT_ENUM_CAST.

// "Class.Enum" for "any::namespace::Class::Enum".
StringName engine_enum_name(const char* p_cpp_name);

template <typename T>
concept NamedEnum = std::is_enum_v<T> && requires {
    EnumName<T>::value;
};

// For T without const and reference. Every specialization has: type, metadata, class_name(), property() with
// no name, from_variant, from_ptr (p_ptr as the engine passes arguments) and to_ptr (p_ptr as the engine
// takes returned values).
template <typename T>
struct TypeInfo;

struct PlainType {
    static constexpr GDExtensionClassMethodArgumentMetadata metadata =
        GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;
    static StringName class_name() { return StringName(); }
};

template <>
struct TypeInfo<bool> : PlainType {
    static constexpr Variant::Type type = Variant::BOOL;
    static PropertyInfo property() { return PropertyInfo(type, StringName()); }
    static bool from_variant(const Variant& p_value) { return p_value; }
    static Variant to_variant(bool p_value) { return p_value; }
    static bool from_ptr(const void* p_ptr) { return *static_cast<const GDExtensionBool*>(p_ptr) != 0; }
    static void to_ptr(bool p_value, void* p_ptr) { *static_cast<GDExtensionBool*>(p_ptr) = p_value; }
};

template <std::integral T>
struct TypeInfo<T> : PlainType {
    static constexpr Variant::Type type = Variant::INT;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata = GDExtensionClassMethodArgumentMetadata(
        (std::is_signed_v<T> ? GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_INT8
                             : GDEXTENSION_METHOD_ARGUMENT_METADATA_INT_IS_UINT8) +
        (sizeof(T) == 1   ? 0
         : sizeof(T) == 2 ? 1
         : sizeof(T) == 4 ? 2
                          : 3));
    static PropertyInfo property() { return PropertyInfo(type, StringName()); }
    static T from_variant(const Variant& p_value) { return T(p_value.operator int64_t()); }
    static Variant to_variant(T p_value) { return int64_t(p_value); }
    static T from_ptr(const void* p_ptr) { return T(*static_cast<const int64_t*>(p_ptr)); }
    static void to_ptr(T p_value, void* p_ptr) { *static_cast<int64_t*>(p_ptr) = int64_t(p_value); }
};

template <std::floating_point T>
struct TypeInfo<T> : PlainType {
    static constexpr Variant::Type type = Variant::FLOAT;
    static constexpr GDExtensionClassMethodArgumentMetadata metadata =
        sizeof(T) == 4 ? GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_FLOAT
                       : GDEXTENSION_METHOD_ARGUMENT_METADATA_REAL_IS_DOUBLE;
    static PropertyInfo property() { return PropertyInfo(type, StringName()); }
    static T from_variant(const Variant& p_value) { return T(p_value.operator double()); }
    static Variant to_variant(T p_value) { return double(p_value); }
    static T from_ptr(const void* p_ptr) { return T(*static_cast<const double*>(p_ptr)); }
    static void to_ptr(T p_value, void* p_ptr) { *static_cast<double*>(p_ptr) = double(p_value); }
};

template <NamedEnum T>
struct TypeInfo<T> : PlainType {
    static constexpr Variant::Type type = Variant::INT;
    static PropertyInfo property() {
        return PropertyInfo(type, StringName(), PROPERTY_HINT_NONE, String(),
                            PROPERTY_USAGE_DEFAULT | PROPERTY_USAGE_CLASS_IS_ENUM,
                            engine_enum_name(EnumName<T>::value));
    }
    static T from_variant(const Variant& p_value) { return T(p_value.operator int64_t()); }
    static Variant to_variant(T p_value) { return int64_t(p_value); }
    static T from_ptr(const void* p_ptr) { return T(*static_cast<const int64_t*>(p_ptr)); }
    static void to_ptr(T p_value, void* p_ptr) { *static_cast<int64_t*>(p_ptr) = int64_t(p_value); }
};

template <NamedEnum T>
struct TypeInfo<BitField<T>> : PlainType {
    static constexpr Variant::Type type = Variant::INT;
    static PropertyInfo property() {
        return PropertyInfo(type, StringName(), PROPERTY_HINT_NONE, String(),
                            PROPERTY_USAGE_DEFAULT | PROPERTY_USAGE_CLASS_IS_BITFIELD,
                            engine_enum_name(EnumName<T>::value));
    }
    static BitField<T> from_variant(const Variant& p_value) { return p_value.operator int64_t(); }
    static Variant to_variant(BitField<T> p_value) { return p_value.value; }
    static BitField<T> from_ptr(const void* p_ptr) { return *static_cast<const int64_t*>(p_ptr); }
    static void to_ptr(BitField<T> p_value, void* p_ptr) { *static_cast<int64_t*>(p_ptr) = p_value.value; }
};

// Types that the engine has too, laid out alike.
template <typename T, int Type>
struct BuiltinTypeInfo : PlainType {
    static constexpr Variant::Type type = Variant::Type(Type);
    static PropertyInfo property() {
        return PropertyInfo(
            type, StringName(), PROPERTY_HINT_NONE, String(),
            PROPERTY_USAGE_DEFAULT | (Type == 0 ? uint32_t(PROPERTY_USAGE_NIL_IS_VARIANT) : 0u));
    }
    static T from_variant(const Variant& p_value) { return p_value; }
    static Variant to_variant(const T& p_value) { return p_value; }
    static const T& from_ptr(const void* p_ptr) { return *static_cast<const T*>(p_ptr); }
    static void to_ptr(const T& p_value, void* p_ptr) { *static_cast<T*>(p_ptr) = p_value; }
};

#define GODOT_BUILTIN_TYPE_INFO(m_type, m_enum) \
    template <>                                 \
    struct TypeInfo<m_type> : BuiltinTypeInfo<m_type, Variant::m_enum> {};
GODOT_BUILTIN_TYPES(GODOT_BUILTIN_TYPE_INFO)
#undef GODOT_BUILTIN_TYPE_INFO

template <>
struct TypeInfo<Variant> : BuiltinTypeInfo<Variant, Variant::NIL> {};

template <typename T>
struct TypeInfo<TypedArray<T>> : PlainType {
    static constexpr Variant::Type type = Variant::ARRAY;
    static PropertyInfo property() {
        const StringName element = TypeInfo<T>::class_name();
        return PropertyInfo(
            type, StringName(), PROPERTY_HINT_ARRAY_TYPE,
            element == StringName() ? Variant::get_type_name(TypeInfo<T>::type) : String(element));
    }
    static TypedArray<T> from_variant(const Variant& p_value) { return p_value.operator Array(); }
    static Variant to_variant(const TypedArray<T>& p_value) { return static_cast<const Array&>(p_value); }
    static TypedArray<T> from_ptr(const void* p_ptr) { return *static_cast<const Array*>(p_ptr); }
    static void to_ptr(const TypedArray<T>& p_value, void* p_ptr) { *static_cast<Array*>(p_ptr) = p_value; }
};

template <typename T>
requires std::derived_from<T, Object>
struct TypeInfo<T*> : PlainType {
    static constexpr Variant::Type type = Variant::OBJECT;
    static StringName class_name() { return T::get_class_static(); }
    static PropertyInfo property() {
        return PropertyInfo(type, StringName(), PROPERTY_HINT_NONE, String(), PROPERTY_USAGE_DEFAULT,
                            class_name());
    }
    static T* from_variant(const Variant& p_value) {
        return Object::cast_to<T>(p_value.get_validated_object());
    }
    static Variant to_variant(const T* p_value) { return p_value; }
    static T* from_ptr(const void* p_ptr) {
        return Object::cast_to<T>(get_object_instance_binding(*static_cast<void* const*>(p_ptr)));
    }
    static void to_ptr(const T* p_value, void* p_ptr) {
        *static_cast<void**>(p_ptr) = p_value == nullptr ? nullptr : p_value->_owner;
    }
};

template <typename T>
struct TypeInfo<Ref<T>> : PlainType {
    static constexpr Variant::Type type = Variant::OBJECT;
    static StringName class_name() { return T::get_class_static(); }
    static PropertyInfo property() {
        return PropertyInfo(type, StringName(), PROPERTY_HINT_RESOURCE_TYPE, class_name());
    }
    static Ref<T> from_variant(const Variant& p_value) { return Ref<T>(p_value); }
    static Variant to_variant(const Ref<T>& p_value) { return p_value; }
    static Ref<T> from_ptr(const void* p_ptr) { return Ref<T>::_shared(TypeInfo<T*>::from_ptr(p_ptr)); }
    static void to_ptr(const Ref<T>& p_value, void* p_ptr) {
        api.ref_set_object(p_ptr, p_value.is_null() ? nullptr : p_value->_owner);
    }
};

// Elements of a TypedArray are named by their class, not by a pointer to it.
template <typename T>
requires std::derived_from<T, Object>
struct TypeInfo<T> : TypeInfo<T*> {
};

}  // namespace godot::internal

// Lets methods and properties have this enumeration's type. To be written outside of any namespace, after its
// class.
#define VARIANT_ENUM_CAST(m_enum)                     \
    namespace godot {                                 \
    template <>                                       \
    struct internal::EnumName<m_enum> {               \
        static constexpr const char* value = #m_enum; \
    };                                                \
    }
#define VARIANT_BITFIELD_CAST(m_enum) VARIANT_ENUM_CAST(m_enum)

VARIANT_ENUM_CAST(Error)
VARIANT_ENUM_CAST(PropertyHint)
VARIANT_ENUM_CAST(Variant::Type)
VARIANT_ENUM_CAST(Object::ConnectFlags)
VARIANT_BITFIELD_CAST(PropertyUsageFlags)
