#pragma once

#include <godot_cpp/core/type_info.hpp>
#include <godot_cpp/variant/typed_array.hpp>

#include <tuple>
#include <utility>
#include <vector>

namespace godot {

// A C++ function that the engine can call, with Variants or with pointers to plain values.
class MethodBind {
  public:
    StringName name;
    uint32_t flags = GDEXTENSION_METHOD_FLAGS_DEFAULT;
    bool has_return = false;
    PropertyInfo return_info;
    GDExtensionClassMethodArgumentMetadata return_metadata = GDEXTENSION_METHOD_ARGUMENT_METADATA_NONE;
    std::vector<PropertyInfo> arguments;
    std::vector<GDExtensionClassMethodArgumentMetadata> argument_metadata;
    std::vector<Variant> defaults;  // Of the last arguments.

    virtual ~MethodBind() = default;
    // `p_args` has one entry per argument, each convertible to the argument's type.
    virtual void call(Wrapped* p_instance, const Variant* const* p_args, Variant& r_return) const = 0;
    virtual void ptrcall(Wrapped* p_instance, const GDExtensionConstTypePtr* p_args,
                         void* r_return) const = 0;
};

namespace internal {

template <typename T>
using Plain = std::remove_cvref_t<T>;

// A function's parts. `Self` is void for one without an instance.
template <typename F>
struct Signature;

template <typename C, typename R, typename... A>
struct Signature<R (C::*)(A...)> {
    using Self = C;
    using Return = R;
    using Arguments = std::tuple<Plain<A>...>;
    static constexpr uint32_t flags = GDEXTENSION_METHOD_FLAG_NORMAL;
};

template <typename C, typename R, typename... A>
struct Signature<R (C::*)(A...) const> : Signature<R (C::*)(A...)> {
    static constexpr uint32_t flags = GDEXTENSION_METHOD_FLAG_NORMAL | GDEXTENSION_METHOD_FLAG_CONST;
};

template <typename R, typename... A>
struct Signature<R (*)(A...)> {
    using Self = void;
    using Return = R;
    using Arguments = std::tuple<Plain<A>...>;
    static constexpr uint32_t flags = GDEXTENSION_METHOD_FLAG_NORMAL | GDEXTENSION_METHOD_FLAG_STATIC;
};

template <typename F, typename... A>
decltype(auto) invoke(F p_function, Wrapped* p_instance, A&&... p_args) {
    using Self = typename Signature<F>::Self;
    if constexpr (std::is_void_v<Self>) {
        return p_function(std::forward<A>(p_args)...);
    } else {
        return (static_cast<Self*>(p_instance)->*p_function)(std::forward<A>(p_args)...);
    }
}

// Calls with plain pointers, as the engine calls methods and virtual methods.
template <typename F, size_t... I>
void invoke_ptr(F p_function, Wrapped* p_instance, [[maybe_unused]] const GDExtensionConstTypePtr* p_args,
                [[maybe_unused]] void* r_return, std::index_sequence<I...>) {
    using S = Signature<F>;
    using A = typename S::Arguments;
    if constexpr (std::is_void_v<typename S::Return>) {
        invoke(p_function, p_instance, TypeInfo<std::tuple_element_t<I, A>>::from_ptr(p_args[I])...);
    } else {
        TypeInfo<Plain<typename S::Return>>::to_ptr(
            invoke(p_function, p_instance, TypeInfo<std::tuple_element_t<I, A>>::from_ptr(p_args[I])...),
            r_return);
    }
}

template <typename F>
class MethodBindFor : public MethodBind {
    using S = Signature<F>;
    using A = typename S::Arguments;
    using Indices = std::make_index_sequence<std::tuple_size_v<A>>;

    F function;

    template <size_t... I>
    void describe(std::index_sequence<I...>) {
        arguments = {TypeInfo<std::tuple_element_t<I, A>>::property()...};
        argument_metadata = {TypeInfo<std::tuple_element_t<I, A>>::metadata...};
    }

    template <size_t... I>
    void call(Wrapped* p_instance, [[maybe_unused]] const Variant* const* p_args,
              [[maybe_unused]] Variant& r_return, std::index_sequence<I...>) const {
        if constexpr (std::is_void_v<typename S::Return>) {
            invoke(function, p_instance, TypeInfo<std::tuple_element_t<I, A>>::from_variant(*p_args[I])...);
        } else {
            r_return = TypeInfo<Plain<typename S::Return>>::to_variant(invoke(
                function, p_instance, TypeInfo<std::tuple_element_t<I, A>>::from_variant(*p_args[I])...));
        }
    }

  public:
    explicit MethodBindFor(F p_function) : function(p_function) {
        flags = S::flags;
        describe(Indices());
        if constexpr (!std::is_void_v<typename S::Return>) {
            has_return = true;
            return_info = TypeInfo<Plain<typename S::Return>>::property();
            return_metadata = TypeInfo<Plain<typename S::Return>>::metadata;
        }
    }

    void call(Wrapped* p_instance, const Variant* const* p_args, Variant& r_return) const override {
        call(p_instance, p_args, r_return, Indices());
    }
    void ptrcall(Wrapped* p_instance, const GDExtensionConstTypePtr* p_args, void* r_return) const override {
        invoke_ptr(function, p_instance, p_args, r_return, Indices());
    }
};

// A member function as the engine calls an override of one of its own virtual methods.
template <auto Function>
void call_virtual(GDExtensionClassInstancePtr p_instance, const GDExtensionConstTypePtr* p_args,
                  void* r_return) {
    using A = typename Signature<decltype(Function)>::Arguments;
    invoke_ptr(Function, static_cast<Wrapped*>(p_instance), p_args, r_return,
               std::make_index_sequence<std::tuple_size_v<A>>());
}

// Makes the engine call `p_call` for the virtual method of its own that the class overrides.
void register_virtual(const StringName& p_class, const StringName& p_method,
                      GDExtensionClassCallVirtual p_call);

template <auto Function>
void bind_virtual(const StringName& p_class, const char* p_method) {
    register_virtual(p_class, p_method, call_virtual<Function>);
}

}  // namespace internal

}  // namespace godot
