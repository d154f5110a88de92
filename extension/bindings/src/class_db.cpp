#include <godot_cpp/core/class_db.hpp>

#include <exception>

namespace godot {

using internal::api;

std::vector<std::unique_ptr<ClassDB::ClassInfo>> ClassDB::classes;
int ClassDB::current_level = 0;

namespace internal {

StringName engine_enum_name(const char* p_cpp_name) {
    const PackedStringArray parts = String(p_cpp_name).split("::", false);
    const int64_t count = parts.size();
    return count < 2 ? parts[0] : parts[count - 2] + "." + parts[count - 1];
}

const GDExtensionPropertyInfo* Hooks::export_property_list(List<PropertyInfo>&& p_list, uint32_t* r_count) {
    PropertyList* list = new PropertyList{std::move(p_list), {}};
    list->c_form.reserve(list->properties.size() + 1);
    for (const PropertyInfo& property : list->properties) {
        list->c_form.push_back(property._to_gdextension());
    }
    *r_count = uint32_t(list->c_form.size());
    // One more entry, past those counted, remembers what to free.
    list->c_form.push_back({GDEXTENSION_VARIANT_TYPE_NIL, list, nullptr, 0, nullptr, 0});
    return list->c_form.data();
}

void Hooks::free_property_list(void*, const GDExtensionPropertyInfo* p_list, uint32_t p_count) {
    // Read first: GCC 12 reads it again after the destructor, which has freed where it stands.
    const PropertyList* list = static_cast<PropertyList*>(p_list[p_count].name);
    delete list;
}

// Converts and checks the arguments, fills in defaults and calls; what is wrong goes into `r_error`.
static void call_method(void* p_bind, GDExtensionClassInstancePtr p_instance,
                        const GDExtensionConstVariantPtr* p_args, GDExtensionInt p_count,
                        GDExtensionVariantPtr r_return, GDExtensionCallError* r_error) {
    const MethodBind& bind = *static_cast<const MethodBind*>(p_bind);
    const size_t wanted = bind.arguments.size();
    const size_t given = size_t(p_count);
    r_error->error = GDEXTENSION_CALL_OK;
    if (given > wanted) {
        r_error->error = GDEXTENSION_CALL_ERROR_TOO_MANY_ARGUMENTS;
        r_error->expected = int32_t(wanted);
        return;
    }
    if (given + bind.defaults.size() < wanted) {
        r_error->error = GDEXTENSION_CALL_ERROR_TOO_FEW_ARGUMENTS;
        r_error->expected = int32_t(wanted - bind.defaults.size());
        return;
    }
    if (p_instance == nullptr && (bind.flags & GDEXTENSION_METHOD_FLAG_STATIC) == 0) {
        r_error->error = GDEXTENSION_CALL_ERROR_INSTANCE_IS_NULL;
        return;
    }
    constexpr size_t kMaximumArguments = 16;  // add_method() checks it.
    const Variant* arguments[kMaximumArguments] = {};
    for (size_t i = 0; i < wanted; i++) {
        arguments[i] = i < given ? static_cast<const Variant*>(p_args[i])
                                 : &bind.defaults[bind.defaults.size() - (wanted - i)];
        const Variant::Type type = bind.arguments[i].type;
        bool fits = type == Variant::NIL || Variant::can_convert_strict(arguments[i]->get_type(), type);
        if (fits && type == Variant::OBJECT) {
            Object* object = arguments[i]->get_validated_object();
            fits = object == nullptr || object->is_class(bind.arguments[i].class_name);
        }
        if (!fits) {
            r_error->error = GDEXTENSION_CALL_ERROR_INVALID_ARGUMENT;
            r_error->argument = int32_t(i);
            r_error->expected = type;
            return;
        }
    }
    bind.call(static_cast<Wrapped*>(p_instance), arguments, *static_cast<Variant*>(r_return));
}

static void ptrcall_method(void* p_bind, GDExtensionClassInstancePtr p_instance,
                           const GDExtensionConstTypePtr* p_args, GDExtensionTypePtr r_return) {
    static_cast<const MethodBind*>(p_bind)->ptrcall(static_cast<Wrapped*>(p_instance), p_args, r_return);
}

}  // namespace internal

ClassDB::ClassInfo* ClassDB::find(const StringName& p_name) {
    for (const std::unique_ptr<ClassInfo>& info : classes) {
        if (info->name == p_name) {
            return info.get();
        }
    }
    return nullptr;
}

ClassDB::ClassInfo* ClassDB::add_class(const StringName& p_name, const StringName& p_parent,
                                       GDExtensionClassCreationInfo5& p_info) {
    ClassInfo* info = classes.emplace_back(std::make_unique<ClassInfo>()).get();
    info->name = p_name;
    info->level = current_level;
    info->parent = find(p_parent);
    p_info.class_userdata = info;
    api.classdb_register_extension_class5(api.library, p_name._native_ptr(), p_parent._native_ptr(), &p_info);
    return info;
}

MethodBind* ClassDB::add_method(ClassInfo* p_class, std::unique_ptr<MethodBind> p_bind,
                                const MethodDefinition& p_definition, std::vector<Variant> p_defaults) {
    const size_t count = p_bind->arguments.size();
    ERR_FAIL_NULL_V_MSG(p_class, nullptr,
                        vformat("The class of method %s isn't registered.", p_definition.name));
    ERR_FAIL_COND_V_MSG(
        count > 16 || p_definition.arguments.size() > count || p_defaults.size() > count, nullptr,
        vformat(
            "Method %s.%s is bound with more argument names or defaults than arguments, or has more than 16.",
            p_class->name, p_definition.name));
    p_bind->name = p_definition.name;
    p_bind->defaults = std::move(p_defaults);
    std::vector<GDExtensionPropertyInfo> arguments;
    for (size_t i = 0; i < count; i++) {
        p_bind->arguments[i].name = i < p_definition.arguments.size()
                                        ? p_definition.arguments[i]
                                        : StringName(vformat("arg%d", int64_t(i)));
        arguments.push_back(p_bind->arguments[i]._to_gdextension());
    }
    std::vector<GDExtensionVariantPtr> defaults;
    for (Variant& value : p_bind->defaults) {
        defaults.push_back(value._native_ptr());
    }
    GDExtensionPropertyInfo return_info = p_bind->return_info._to_gdextension();
    GDExtensionClassMethodInfo info = {};
    info.name = p_bind->name._native_ptr();
    info.method_userdata = p_bind.get();
    info.call_func = internal::call_method;
    info.ptrcall_func = internal::ptrcall_method;
    info.method_flags = p_bind->flags;
    info.has_return_value = p_bind->has_return;
    info.return_value_info = &return_info;
    info.return_value_metadata = p_bind->return_metadata;
    info.argument_count = uint32_t(count);
    info.arguments_info = arguments.data();
    info.arguments_metadata = p_bind->argument_metadata.data();
    info.default_argument_count = uint32_t(defaults.size());
    info.default_arguments = defaults.data();
    api.classdb_register_extension_class_method(api.library, p_class->name._native_ptr(), &info);
    return p_class->methods.emplace_back(std::move(p_bind)).get();
}

void ClassDB::add_property(const StringName& p_class, const PropertyInfo& p_info, const StringName& p_setter,
                           const StringName& p_getter, int p_index) {
    const GDExtensionPropertyInfo info = p_info._to_gdextension();
    api.classdb_register_extension_class_property_indexed(
        api.library, p_class._native_ptr(), &info, p_setter._native_ptr(), p_getter._native_ptr(), p_index);
}

void ClassDB::add_property_group(const StringName& p_class, const String& p_name, const String& p_prefix) {
    api.classdb_register_extension_class_property_group(api.library, p_class._native_ptr(),
                                                        p_name._native_ptr(), p_prefix._native_ptr());
}

void ClassDB::add_property_subgroup(const StringName& p_class, const String& p_name, const String& p_prefix) {
    api.classdb_register_extension_class_property_subgroup(api.library, p_class._native_ptr(),
                                                           p_name._native_ptr(), p_prefix._native_ptr());
}

void ClassDB::add_signal(const StringName& p_class, const MethodInfo& p_signal) {
    std::vector<GDExtensionPropertyInfo> arguments;
    for (const PropertyInfo& argument : p_signal.arguments) {
        arguments.push_back(argument._to_gdextension());
    }
    api.classdb_register_extension_class_signal(api.library, p_class._native_ptr(),
                                                p_signal.name._native_ptr(), arguments.data(),
                                                int64_t(arguments.size()));
}

void ClassDB::bind_integer_constant(const StringName& p_class, const StringName& p_enum,
                                    const StringName& p_name, int64_t p_value, bool p_is_bitfield) {
    api.classdb_register_extension_class_integer_constant(api.library, p_class._native_ptr(),
                                                          p_enum._native_ptr(), p_name._native_ptr(), p_value,
                                                          p_is_bitfield);
}

void internal::register_virtual(const StringName& p_class, const StringName& p_method,
                                GDExtensionClassCallVirtual p_call) {
    ClassDB::ClassInfo* info = ClassDB::find(p_class);
    info->virtuals[p_method._key()] = p_call;
    info->virtual_names.push_back(p_method);
}

GDExtensionClassCallVirtual ClassDB::get_virtual(void* p_class, GDExtensionConstStringNamePtr p_name,
                                                 uint32_t) {
    const uintptr_t key = static_cast<const StringName*>(p_name)->_key();
    for (const ClassInfo* info = static_cast<ClassInfo*>(p_class); info != nullptr; info = info->parent) {
        const auto found = info->virtuals.find(key);
        if (found != info->virtuals.end()) {
            return found->second;
        }
    }
    return nullptr;
}

void ClassDB::unregister_level(int p_level) {
    while (!classes.empty() && classes.back()->level == p_level) {
        api.classdb_unregister_extension_class(api.library, classes.back()->name._native_ptr());
        classes.pop_back();
    }
}

}  // namespace godot
