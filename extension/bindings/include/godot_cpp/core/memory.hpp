#pragma once

#include <godot_cpp/core/interface.hpp>

#include <type_traits>

namespace godot {

class Wrapped;

namespace internal {

// Says which class the next Wrapped constructed on this thread belongs to. See Wrapped::Wrapped().
template <typename T>
void announce_construction();

template <typename T>
void pre_initialize() {
    if constexpr (std::is_base_of_v<Wrapped, T>) {
        announce_construction<T>();
    }
}

template <typename T>
T* post_initialize(T* p_object) {
    if constexpr (std::is_base_of_v<Wrapped, T>) {
        p_object->_post_initialize();
    }
    return p_object;
}

}  // namespace internal

// An object is freed by the engine, which then frees the C++ instance: directly if it is ours, as a binding
// if it wraps.
template <typename T>
void memdelete(T* p_object) {
    if constexpr (std::is_base_of_v<Wrapped, T>) {
        internal::api.object_destroy(p_object->_owner);
    } else {
        delete p_object;
    }
}

}  // namespace godot

#define memnew(m_class)                                                                 \
    (::godot::internal::pre_initialize<std::remove_pointer_t<decltype(new m_class)>>(), \
     ::godot::internal::post_initialize(new m_class))
