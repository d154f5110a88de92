#pragma once

#include <godot_cpp/core/type_info.hpp>

// How the generated wrappers call the engine: every argument as a pointer to its widened value.
namespace godot::internal {

struct EnginePointer {
    const void* value;
};

template <typename T>
struct IsBitField : std::false_type {};
template <typename T>
struct IsBitField<BitField<T>> : std::true_type {};
template <typename T>
struct IsRef : std::false_type {};
template <typename T>
struct IsRef<Ref<T>> : std::true_type {};

// An argument in the engine's form: a widened number, an object's address, or the address of a type that both
// share.
template <typename T>
auto encode(const T& p_value) {
    if constexpr (std::is_same_v<T, bool>) {
        return GDExtensionBool(p_value);
    } else if constexpr (std::is_integral_v<T> || std::is_enum_v<T> || IsBitField<T>::value) {
        return int64_t(p_value);
    } else if constexpr (std::is_floating_point_v<T>) {
        return double(p_value);
    } else if constexpr (std::is_pointer_v<T>) {
        return p_value == nullptr ? static_cast<void*>(nullptr)
                                  : reinterpret_cast<const Object*>(p_value)->_owner;
    } else if constexpr (IsRef<T>::value) {
        return encode(p_value.ptr());
    } else {
        return EnginePointer{&p_value};
    }
}

template <typename T>
const void* address_of(const T& p_encoded) {
    return &p_encoded;
}
inline const void* address_of(const EnginePointer& p_encoded) {
    return p_encoded.value;
}

// Calls `p_call(arguments, place for the result)` and returns the result as an R.
template <typename R, typename F, typename... Encoded>
R call_encoded(const F& p_call, const Encoded&... p_encoded) {
    const void* arguments[sizeof...(Encoded) + 1] = {address_of(p_encoded)..., nullptr};
    if constexpr (std::is_void_v<R>) {
        p_call(arguments, nullptr);
    } else if constexpr (std::is_same_v<R, bool>) {
        GDExtensionBool value = 0;
        p_call(arguments, &value);
        return value != 0;
    } else if constexpr (std::is_integral_v<R> || std::is_enum_v<R> || IsBitField<R>::value) {
        int64_t value = 0;
        p_call(arguments, &value);
        return R(value);
    } else if constexpr (std::is_floating_point_v<R>) {
        double value = 0;
        p_call(arguments, &value);
        return R(value);
    } else if constexpr (std::is_pointer_v<R>) {
        void* owner = nullptr;
        p_call(arguments, &owner);
        return reinterpret_cast<R>(get_object_instance_binding(owner));
    } else if constexpr (IsRef<R>::value) {
        void* owner = nullptr;
        p_call(arguments, &owner);
        return R::_adopted(reinterpret_cast<decltype(R().ptr())>(get_object_instance_binding(owner)));
    } else {
        R value;
        p_call(arguments, &value);
        return value;
    }
}

// A method of an engine class. Made once per method, on its first call.
class EngineMethod {
    GDExtensionMethodBindPtr bind;

  public:
    EngineMethod(const StringName& p_class, const char* p_name, int64_t p_hash);

    template <typename R, typename... A>
    R call(void* p_owner, const A&... p_args) const {
        return call_encoded<R>(
            [&](const void* const* p_arguments, void* r_value) {
                if (bind != nullptr) {
                    api.object_method_bind_ptrcall(bind, p_owner, p_arguments, r_value);
                }
            },
            encode(p_args)...);
    }
    Variant call_variants(void* p_owner, const Variant** p_args, int64_t p_count) const;
};

class BuiltinMethod {
    GDExtensionPtrBuiltInMethod method;

  public:
    BuiltinMethod(int p_type, const char* p_name, int64_t p_hash);

    template <typename R, typename... A>
    R call(const void* p_base, const A&... p_args) const {
        return call_encoded<R>(
            [&](const void* const* p_arguments, void* r_value) {
                method(const_cast<void*>(p_base), p_arguments, r_value, int32_t(sizeof...(A)));
            },
            encode(p_args)...);
    }
    void call_variants(const void* p_base, const Variant** p_args, int64_t p_count, void* r_value) const;
};

class UtilityFunction {
    GDExtensionPtrUtilityFunction function;

  public:
    UtilityFunction(const char* p_name, int64_t p_hash);
    void call_variants(const Variant** p_args, int64_t p_count, void* r_value) const;
};

template <typename... A>
void construct(int p_type, int p_index, void* r_value, const A&... p_args) {
    call_encoded<void>(
        [&](const void* const* p_arguments, void*) {
            api.variant_get_ptr_constructor(GDExtensionVariantType(p_type), p_index)(r_value, p_arguments);
        },
        encode(p_args)...);
}

// The result of one of the engine's comparisons.
bool compare(GDExtensionPtrOperatorEvaluator p_evaluator, const void* p_left, const void* p_right);

}  // namespace godot::internal
