#pragma once

#include <godot_cpp/core/memory.hpp>
#include <godot_cpp/core/property_info.hpp>
#include <godot_cpp/templates/list.hpp>
#include <godot_cpp/variant/variant.hpp>

namespace godot {

class ClassDB;
class Object;

namespace internal {

struct Hooks;

// A StringName that lives until the extension is unloaded: the engine is gone when static destructors run.
const StringName& intern(const char* p_name);

// The C++ object for an engine object, made on first sight as the most derived class that the bindings list.
Object* get_object_instance_binding(void* p_owner);

}  // namespace internal

// Root of every C++ class that stands for an engine object. An engine class's instance wraps an object; an
// instance of one of our classes extends an object of its nearest engine ancestor and is freed with it.
class Wrapped {
    friend struct internal::Hooks;

    template <typename T>
    friend void internal::announce_construction();
    template <typename T>
    friend T* internal::post_initialize(T* p_object);

    static void announce(const StringName* p_extension_class,
                         const GDExtensionInstanceBindingCallbacks* p_callbacks,
                         void* p_recreated_owner = nullptr);
    void _post_initialize();

  protected:
    explicit Wrapped(const char* p_engine_class);
    explicit Wrapped(void* p_owner) : _owner(p_owner) {}
    virtual ~Wrapped() = default;

    // Hooks that a class may define for itself, with these signatures. They aren't virtual: each class's own
    // runs.
    static void _bind_methods() {}
    void _notification(int) {}
    bool _set(const StringName&, const Variant&) { return false; }
    bool _get(const StringName&, Variant&) const { return false; }
    void _get_property_list(List<PropertyInfo>*) const {}
    bool _property_can_revert(const StringName&) const { return false; }
    bool _property_get_revert(const StringName&, Variant&) const { return false; }
    void _validate_property(PropertyInfo&) const {}
    String _to_string() const { return String(); }

  public:
    Wrapped(const Wrapped&) = delete;
    Wrapped& operator=(const Wrapped&) = delete;

    static constexpr bool _is_extension = false;

    template <typename T, typename B>
    static void register_virtuals() {}

    void* _owner = nullptr;  // The engine's object. Not for use outside of the bindings.
};

namespace internal {

// What the engine calls to wrap an object as T, an engine class, and to drop the wrapper.
template <typename T>
struct EngineBinding {
    static void* create(void*, void* p_owner) { return static_cast<Wrapped*>(new T(p_owner)); }
    static void free(void*, void*, void* p_binding) {
        delete static_cast<T*>(static_cast<Wrapped*>(p_binding));
    }
    static GDExtensionBool reference(void*, void*, GDExtensionBool) { return true; }
    static constexpr GDExtensionInstanceBindingCallbacks callbacks = {create, free, reference};
};

// An extension's object is its own binding, so there is nothing to make or free.
struct ExtensionBinding {
    static void* create(void*, void*) { return nullptr; }
    static void free(void*, void*, void*) {}
    static GDExtensionBool reference(void*, void*, GDExtensionBool) { return true; }
    static constexpr GDExtensionInstanceBindingCallbacks callbacks = {create, free, reference};
};

template <typename T>
void announce_construction() {
    if constexpr (T::_is_extension) {
        Wrapped::announce(&T::get_class_static(), &ExtensionBinding::callbacks);
    } else {
        Wrapped::announce(nullptr, &EngineBinding<T>::callbacks);
    }
}

}  // namespace internal

}  // namespace godot

// First line of every engine class's wrapper. Made by the generator.
#define GODOT_ENGINE_CLASS(m_class, m_inherits)                                       \
    friend struct ::godot::internal::EngineBinding<m_class>;                          \
                                                                                      \
  protected:                                                                          \
    explicit m_class(const char* p_engine_class) : m_inherits(p_engine_class) {}      \
    explicit m_class(void* p_owner) : m_inherits(p_owner) {}                          \
                                                                                      \
  public:                                                                             \
    using self_type = m_class;                                                        \
    using parent_type = m_inherits;                                                   \
    m_class() : m_class(#m_class) {}                                                  \
    static const ::godot::StringName& get_class_static() {                            \
        static const ::godot::StringName& name = ::godot::internal::intern(#m_class); \
        return name;                                                                  \
    }

// First line of every class of the extension.
#define GDCLASS(m_class, m_inherits)                                                  \
    friend struct ::godot::internal::Hooks;                                           \
    friend class ::godot::ClassDB;                                                    \
                                                                                      \
  public:                                                                             \
    using self_type = m_class;                                                        \
    using parent_type = m_inherits;                                                   \
    static constexpr bool _is_extension = true;                                       \
    static const ::godot::StringName& get_class_static() {                            \
        static const ::godot::StringName& name = ::godot::internal::intern(#m_class); \
        return name;                                                                  \
    }                                                                                 \
    static const ::godot::StringName& get_parent_class_static() {                     \
        return m_inherits::get_class_static();                                        \
    }                                                                                 \
                                                                                      \
  private:
