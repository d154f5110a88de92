#pragma once

#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/core/method_bind.hpp>
#include <godot_cpp/core/object.hpp>
#include <godot_cpp/core/print_string.hpp>
#include <godot_cpp/godot.hpp>

#include <cstring>
#include <memory>
#include <unordered_map>

#define DEFVAL(m_value) (m_value)

namespace godot {

struct MethodDefinition {
    StringName name;
    std::vector<StringName> arguments;
};

template <typename... Args>
MethodDefinition D_METHOD(const StringName& p_name, const Args&... p_arguments) {
    return {p_name, {StringName(p_arguments)...}};
}

namespace internal {

// Which of the hooks a class declares itself, and how to run its ancestors' as well. The first argument of
// each is the instance as the engine knows it.
struct Hooks {
    // Whether T itself declares the member that `p_own` points to, rather than inheriting it.
    template <typename T, typename R, typename C, typename... A>
    static constexpr bool owns(R (C::*)(A...)) {
        return std::is_same_v<C, T>;
    }
    template <typename T, typename R, typename C, typename... A>
    static constexpr bool owns(R (C::*)(A...) const) {
        return std::is_same_v<C, T>;
    }

    template <typename T>
    static T* self(void* p_instance) {
        return static_cast<T*>(static_cast<Wrapped*>(p_instance));
    }

    template <typename T>
    static void notification(void* p_instance, int32_t p_what, GDExtensionBool p_reversed) {
        if constexpr (T::_is_extension) {
            if (!p_reversed) {
                notification<typename T::parent_type>(p_instance, p_what, p_reversed);
            }
            if constexpr (owns<T>(&T::_notification)) {
                self<T>(p_instance)->_notification(p_what);
            }
            if (p_reversed) {
                notification<typename T::parent_type>(p_instance, p_what, p_reversed);
            }
        }
    }

    template <typename T>
    static GDExtensionBool set(void* p_instance, const void* p_name, const void* p_value) {
        if constexpr (T::_is_extension) {
            if (set<typename T::parent_type>(p_instance, p_name, p_value)) {
                return true;
            }
            if constexpr (owns<T>(&T::_set)) {
                return self<T>(p_instance)
                    ->_set(*static_cast<const StringName*>(p_name), *static_cast<const Variant*>(p_value));
            }
        }
        return false;
    }

    template <typename T>
    static GDExtensionBool get(void* p_instance, const void* p_name, void* r_value) {
        if constexpr (T::_is_extension) {
            if (get<typename T::parent_type>(p_instance, p_name, r_value)) {
                return true;
            }
            if constexpr (owns<T>(&T::_get)) {
                return self<T>(p_instance)
                    ->_get(*static_cast<const StringName*>(p_name), *static_cast<Variant*>(r_value));
            }
        }
        return false;
    }

    // The list and its C form, which points into it, live until the engine returns the C form.
    struct PropertyList {
        List<PropertyInfo> properties;
        std::vector<GDExtensionPropertyInfo> c_form;
    };

    // The engine asks each class of the extension in turn, so this is for T alone. Null if T has none.
    template <typename T>
    static GDExtensionClassGetPropertyList get_property_list_function() {
        if constexpr (owns<T>(&T::_get_property_list)) {
            return [](GDExtensionClassInstancePtr p_instance, uint32_t* r_count) {
                List<PropertyInfo> properties;
                self<T>(p_instance)->_get_property_list(&properties);
                return export_property_list(std::move(properties), r_count);
            };
        } else {
            return nullptr;
        }
    }
    static const GDExtensionPropertyInfo* export_property_list(List<PropertyInfo>&& p_list,
                                                               uint32_t* r_count);
    static void free_property_list(void* p_instance, const GDExtensionPropertyInfo* p_list, uint32_t p_count);

    template <typename T>
    static GDExtensionBool property_can_revert(void* p_instance, const void* p_name) {
        if constexpr (T::_is_extension) {
            if constexpr (owns<T>(&T::_property_can_revert)) {
                return self<T>(p_instance)->_property_can_revert(*static_cast<const StringName*>(p_name));
            }
            return property_can_revert<typename T::parent_type>(p_instance, p_name);
        }
        return false;
    }

    template <typename T>
    static GDExtensionBool property_get_revert(void* p_instance, const void* p_name, void* r_value) {
        if constexpr (T::_is_extension) {
            if constexpr (owns<T>(&T::_property_get_revert)) {
                return self<T>(p_instance)
                    ->_property_get_revert(*static_cast<const StringName*>(p_name),
                                           *static_cast<Variant*>(r_value));
            }
            return property_get_revert<typename T::parent_type>(p_instance, p_name, r_value);
        }
        return false;
    }

    template <typename T>
    static GDExtensionBool validate_property(void* p_instance, GDExtensionPropertyInfo* p_property) {
        bool changed = false;
        if constexpr (T::_is_extension) {
            changed = validate_property<typename T::parent_type>(p_instance, p_property);
            if constexpr (owns<T>(&T::_validate_property)) {
                PropertyInfo info(p_property);
                self<T>(p_instance)->_validate_property(info);
                info._update(p_property);
                changed = true;
            }
        }
        return changed;
    }

    template <typename T>
    static void to_string(void* p_instance, GDExtensionBool* r_is_valid, void* r_out) {
        if constexpr (T::_is_extension) {
            if constexpr (owns<T>(&T::_to_string)) {
                *static_cast<String*>(r_out) = self<T>(p_instance)->_to_string();
                *r_is_valid = true;
            } else {
                to_string<typename T::parent_type>(p_instance, r_is_valid, r_out);
            }
        }
    }

    template <typename T>
    static GDExtensionObjectPtr create(void*, GDExtensionBool p_notify_post_initialize) {
        announce_construction<T>();
        T* object = new T;
        if (p_notify_post_initialize) {
            object->_post_initialize();
        }
        return object->_owner;
    }

    // After a hot reload: a new instance for an object that the engine has kept.
    template <typename T>
    static GDExtensionClassInstancePtr recreate(void*, GDExtensionObjectPtr p_owner) {
        Wrapped::announce(nullptr, &ExtensionBinding::callbacks, p_owner);
        return static_cast<Wrapped*>(new T);
    }

    template <typename T>
    static void free(void*, GDExtensionClassInstancePtr p_instance) {
        delete self<T>(p_instance);
    }

    template <typename T>
    static void bind() {
        T::_bind_methods();
    }
};

}  // namespace internal

// Registers the extension's classes with the engine.
class ClassDB {
    friend class GDExtensionBinding;
    friend void internal::register_virtual(const StringName& p_class, const StringName& p_method,
                                           GDExtensionClassCallVirtual p_call);

    struct ClassInfo {
        StringName name;
        int level = 0;
        ClassInfo* parent = nullptr;  // Null if it is an engine class.
        std::unordered_map<uintptr_t, GDExtensionClassCallVirtual> virtuals;  // By StringName::_key().
        std::vector<StringName> virtual_names;                                // Keeps the keys alive.
        std::vector<std::unique_ptr<MethodBind>> methods;
    };
    // In order of registration, so that parents come first. They stay where they are: the engine holds their
    // address.
    static std::vector<std::unique_ptr<ClassInfo>> classes;
    static int current_level;

    static ClassInfo* find(const StringName& p_name);
    static ClassInfo* add_class(const StringName& p_name, const StringName& p_parent,
                                GDExtensionClassCreationInfo5& p_info);
    static MethodBind* add_method(ClassInfo* p_class, std::unique_ptr<MethodBind> p_bind,
                                  const MethodDefinition& p_definition, std::vector<Variant> p_defaults);
    static GDExtensionClassCallVirtual get_virtual(void* p_class, GDExtensionConstStringNamePtr p_name,
                                                   uint32_t p_hash);
    static void unregister_level(int p_level);

    template <typename T>
    static void register_class(bool p_abstract, bool p_virtual, bool p_exposed, bool p_runtime) {
        static_assert(std::is_same_v<typename T::self_type, T>, "The class needs GDCLASS.");
        using internal::Hooks;
        GDExtensionClassCreationInfo5 info = {};
        info.is_virtual = p_virtual;
        info.is_abstract = p_abstract;
        info.is_exposed = p_exposed;
        info.is_runtime = p_runtime;
        info.set_func = Hooks::set<T>;
        info.get_func = Hooks::get<T>;
        info.get_property_list_func = Hooks::get_property_list_function<T>();
        info.free_property_list_func = Hooks::free_property_list;
        info.property_can_revert_func = Hooks::property_can_revert<T>;
        info.property_get_revert_func = Hooks::property_get_revert<T>;
        info.validate_property_func = Hooks::validate_property<T>;
        info.notification_func = Hooks::notification<T>;
        info.to_string_func = Hooks::to_string<T>;
        if constexpr (!std::is_abstract_v<T>) {
            info.create_instance_func = Hooks::create<T>;
            info.recreate_instance_func = Hooks::recreate<T>;
        }
        info.free_instance_func = Hooks::free<T>;
        info.get_virtual_func = get_virtual;
        add_class(T::get_class_static(), T::parent_type::get_class_static(), info);
        T::parent_type::template register_virtuals<T, typename T::parent_type>();
        Hooks::bind<T>();
    }

  public:
    template <typename T>
    static void register_class(bool p_virtual = false) {
        register_class<T>(false, p_virtual, true, false);
    }
    template <typename T>
    static void register_abstract_class() {
        register_class<T>(true, false, true, false);
    }
    template <typename T>
    static void register_internal_class() {
        register_class<T>(false, false, false, false);
    }
    template <typename T>
    static void register_runtime_class() {
        register_class<T>(false, false, true, true);
    }

    template <typename F, typename... Defaults>
    static MethodBind* bind_method(const MethodDefinition& p_definition, F p_function,
                                   const Defaults&... p_defaults) {
        using Self = typename internal::Signature<F>::Self;
        static_assert(!std::is_void_v<Self>, "A function without an instance needs bind_static_method().");
        return add_method(find(Self::get_class_static()),
                          std::make_unique<internal::MethodBindFor<F>>(p_function), p_definition,
                          {Variant(p_defaults)...});
    }
    template <typename F, typename... Defaults>
    static MethodBind* bind_method(const char* p_name, F p_function, const Defaults&... p_defaults) {
        return bind_method(D_METHOD(p_name), p_function, p_defaults...);
    }
    template <typename F, typename... Defaults>
    static MethodBind* bind_static_method(const StringName& p_class, const MethodDefinition& p_definition,
                                          F p_function, const Defaults&... p_defaults) {
        return add_method(find(p_class), std::make_unique<internal::MethodBindFor<F>>(p_function),
                          p_definition, {Variant(p_defaults)...});
    }

    static void add_property(const StringName& p_class, const PropertyInfo& p_info,
                             const StringName& p_setter, const StringName& p_getter, int p_index = -1);
    static void add_property_group(const StringName& p_class, const String& p_name, const String& p_prefix);
    static void add_property_subgroup(const StringName& p_class, const String& p_name,
                                      const String& p_prefix);
    static void add_signal(const StringName& p_class, const MethodInfo& p_signal);
    static void bind_integer_constant(const StringName& p_class, const StringName& p_enum,
                                      const StringName& p_name, int64_t p_value, bool p_is_bitfield = false);
};

namespace internal {

// "Enum" for a value of type Class::Enum, which must have had VARIANT_ENUM_CAST.
template <typename E>
StringName enum_name_of(E) {
    const char* last = EnumName<E>::value;
    for (const char* next = last; (next = std::strstr(next, "::")) != nullptr;) {
        last = next += 2;
    }
    return StringName(last);
}

}  // namespace internal

}  // namespace godot

#define ADD_SIGNAL(m_signal) ::godot::ClassDB::add_signal(get_class_static(), m_signal)
#define ADD_GROUP(m_name, m_prefix) ::godot::ClassDB::add_property_group(get_class_static(), m_name, m_prefix)
#define ADD_SUBGROUP(m_name, m_prefix) \
    ::godot::ClassDB::add_property_subgroup(get_class_static(), m_name, m_prefix)
#define ADD_PROPERTY(m_property, m_setter, m_getter) \
    ::godot::ClassDB::add_property(get_class_static(), m_property, m_setter, m_getter)
#define ADD_PROPERTYI(m_property, m_setter, m_getter, m_index) \
    ::godot::ClassDB::add_property(get_class_static(), m_property, m_setter, m_getter, m_index)
#define BIND_CONSTANT(m_constant) \
    ::godot::ClassDB::bind_integer_constant(get_class_static(), "", #m_constant, m_constant);
#define BIND_ENUM_CONSTANT(m_constant)                                                                       \
    ::godot::ClassDB::bind_integer_constant(get_class_static(), ::godot::internal::enum_name_of(m_constant), \
                                            #m_constant, m_constant);
#define BIND_BITFIELD_FLAG(m_constant)                                                                       \
    ::godot::ClassDB::bind_integer_constant(get_class_static(), ::godot::internal::enum_name_of(m_constant), \
                                            #m_constant, m_constant, true);
#define GDREGISTER_CLASS(m_class) ::godot::ClassDB::register_class<m_class>();
#define GDREGISTER_VIRTUAL_CLASS(m_class) ::godot::ClassDB::register_class<m_class>(true);
#define GDREGISTER_ABSTRACT_CLASS(m_class) ::godot::ClassDB::register_abstract_class<m_class>();
#define GDREGISTER_INTERNAL_CLASS(m_class) ::godot::ClassDB::register_internal_class<m_class>();
#define GDREGISTER_RUNTIME_CLASS(m_class) ::godot::ClassDB::register_runtime_class<m_class>();
