#pragma once

#include <godot_cpp/core/type_info.hpp>

namespace godot {

// An Array that the engine lets hold Ts alone.
template <typename T>
class TypedArray : public Array {
  public:
    TypedArray() {
        using Info = internal::TypeInfo<T>;
        set_typed(Info::type, Info::class_name(), Variant());
    }
    // Shares the array if it has this type, else holds converted copies.
    TypedArray(const Array& p_array) : TypedArray() {
        if (is_same_typed(p_array)) {
            Array::operator=(p_array);
        } else {
            assign(p_array);
        }
    }
    TypedArray(const Variant& p_value) : TypedArray(p_value.operator Array()) {}
    TypedArray(std::initializer_list<Variant> p_values) : TypedArray(Array(p_values)) {}
};

}  // namespace godot
