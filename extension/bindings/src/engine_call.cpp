#include <godot_cpp/core/engine_call.hpp>
#include <godot_cpp/core/error_macros.hpp>

namespace godot::internal {

EngineMethod::EngineMethod(const StringName& p_class, const char* p_name, int64_t p_hash)
    : bind(api.classdb_get_method_bind(p_class._native_ptr(), StringName(p_name)._native_ptr(), p_hash)) {
    if (bind == nullptr) {
        ERR_PRINT(vformat("This engine has no method %s.%s as the extension knows it.", p_class, p_name));
    }
}

Variant EngineMethod::call_variants(void* p_owner, const Variant** p_args, int64_t p_count) const {
    Variant result;
    if (bind == nullptr) {
        return result;
    }
    GDExtensionCallError error = {};
    api.object_method_bind_call(bind, p_owner, reinterpret_cast<const GDExtensionConstVariantPtr*>(p_args),
                                p_count, result._native_ptr(), &error);
    return result;
}

BuiltinMethod::BuiltinMethod(int p_type, const char* p_name, int64_t p_hash)
    : method(api.variant_get_ptr_builtin_method(GDExtensionVariantType(p_type),
                                                StringName(p_name)._native_ptr(), p_hash)) {}

void BuiltinMethod::call_variants(const void* p_base, const Variant** p_args, int64_t p_count,
                                  void* r_value) const {
    method(const_cast<void*>(p_base), reinterpret_cast<const GDExtensionConstTypePtr*>(p_args), r_value,
           int32_t(p_count));
}

UtilityFunction::UtilityFunction(const char* p_name, int64_t p_hash)
    : function(api.variant_get_ptr_utility_function(StringName(p_name)._native_ptr(), p_hash)) {}

void UtilityFunction::call_variants(const Variant** p_args, int64_t p_count, void* r_value) const {
    function(r_value, reinterpret_cast<const GDExtensionConstTypePtr*>(p_args), int32_t(p_count));
}

bool compare(GDExtensionPtrOperatorEvaluator p_evaluator, const void* p_left, const void* p_right) {
    GDExtensionBool result = false;
    p_evaluator(p_left, p_right, &result);
    return result != 0;
}

}  // namespace godot::internal
