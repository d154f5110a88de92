#!/usr/bin/env python3
"""Writes the C++ wrappers of the engine's types from the description that the engine prints of itself.

    generate.py API_JSON CLASSES_TXT OUTPUT_DIRECTORY

API_JSON comes from `godot --dump-extension-api`. CLASSES_TXT lists engine classes, one per line; their ancestors are
added. Files that would not change are left alone, so that nothing is compiled needlessly.
"""

import json
import re
import sys
from pathlib import Path

from wrapped_types import EXTENDED_TYPES, GLOBAL_ENUMS, MATH_TYPES, NUMBERS, OPAQUE_TYPES, PACKED_ELEMENTS

CPP_KEYWORDS = {"class", "default", "delete", "new", "operator", "switch", "template", "typename", "union", "char"}
NOTE = "// Made by extension/bindings/generate.py.\n"


def snake_case(name):
    """Godot's file name for a class: ResourceUID -> resource_uid, Node3D -> node3d, AABB -> aabb."""
    name = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name)
    name = re.sub(r"([A-Z]+)([A-Z][a-z])", r"\1_\2", name).lower()
    return re.sub(r"(\d)_d\b", r"\1d", name).replace("2_d", "2d").replace("3_d", "3d")


class Skip(Exception):
    """A signature that uses something that isn't wrapped."""


class Generator:
    def __init__(self, api, listed, output):
        if api["header"].get("precision", "single") != "single":
            raise SystemExit("generate.py: the engine was built with double precision, which isn't supported.")
        self.output = output
        self.builtins = {b["name"]: b for b in api["builtin_classes"]}
        sizes = next(s for s in api["builtin_class_sizes"] if s["build_configuration"] == "float_64")
        self.sizes = {s["name"]: s["size"] for s in sizes["sizes"]}
        self.enums = {e["name"]: e for e in api["global_enums"]}
        self.types = {v["name"]: v["value"] for v in self.enums["Variant.Type"]["values"]}
        self.utilities = api["utility_functions"]
        self.singletons = {s["type"] for s in api["singletons"]}
        self.all_classes = {c["name"]: c for c in api["classes"]}
        self.classes = {}
        for name in ["RefCounted", *listed]:
            if name not in self.all_classes:
                raise SystemExit(f"generate.py: the engine has no class {name!r}; correct classes.txt.")
            while name:
                self.classes[name] = self.all_classes[name]
                name = self.all_classes[name].get("inherits")

    # Parents come before their children.
    def sorted_classes(self):
        return sorted(self.classes, key=lambda name: (self.depth(name), name))

    def depth(self, name):
        parent = self.classes[name].get("inherits")
        return 0 if not parent else 1 + self.depth(parent)

    def write(self, path, text):
        path = self.output / path
        path.parent.mkdir(parents=True, exist_ok=True)
        text = NOTE + text
        if not path.exists() or path.read_text() != text:
            path.write_text(text)

    # --- Types -------------------------------------------------------------------------------------------------------

    def enum_type(self, name):
        if name.startswith("Variant."):
            return "Variant::" + name.split(".")[1]
        if "." in name:
            owner, enum = name.split(".")
            if owner not in self.classes:
                raise Skip
            return f"{owner}::{enum}"
        if name not in GLOBAL_ENUMS:
            raise Skip
        return name

    def value_type(self, type_name, meta=None):
        """The C++ type of a value, as returned."""
        if meta in NUMBERS or (meta == "float" and type_name == "float"):
            return "float" if meta == "float" else NUMBERS[meta]
        if type_name in NUMBERS:
            return NUMBERS[type_name]
        if type_name == "Variant" or type_name in MATH_TYPES or type_name in OPAQUE_TYPES:
            return type_name
        kind, _, rest = type_name.partition("::")
        if kind == "enum":
            return self.enum_type(rest)
        if kind == "bitfield":
            return f"BitField<{self.enum_type(rest)}>"
        if kind == "typedarray":
            element = rest.split(":")[-1]
            if element in self.classes or element in MATH_TYPES or element in OPAQUE_TYPES:
                return f"TypedArray<{element}>"
            raise Skip
        if type_name in self.classes:
            return f"Ref<{type_name}>" if self.classes[type_name]["is_refcounted"] else f"{type_name} *"
        raise Skip

    def argument_type(self, argument):
        value = self.value_type(argument["type"], argument.get("meta"))
        passed_by_value = value in NUMBERS.values() or value == "float" or value.endswith("*")
        if passed_by_value or argument["type"].startswith(("enum::", "bitfield::")):
            return value
        return f"const {value} &"

    def default_value(self, argument, cpp_type):
        text = argument["default_value"]
        plain = cpp_type.removeprefix("const ").removesuffix(" &")
        if plain in ("bool", "double", "float") or plain in NUMBERS.values():
            return text
        if text == "null":
            return "Variant()" if plain == "Variant" else "nullptr"
        if argument["type"].startswith(("enum::", "bitfield::")):
            return f"{plain}({text})"
        if re.fullmatch(r"""&?"[^"]*"|\[\]|\{\}|Array\[.*\]\(\[\]\)|(NodePath|Callable|RID|\w+Array)\((""|\[\])?\)""", text):
            inner = re.search(r'"([^"]+)"', text)
            return f'"{inner.group(1)}"' if inner and plain in ("String", "StringName") else f"{plain}()"
        if text in ("Transform3D(1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0)", "Transform2D(1, 0, 0, 1, 0, 0)"):
            return f"{plain}()"
        if plain == "AABB" and set(re.findall(r"\d+", text)) == {"0"}:
            return f"{plain}()"
        if re.fullmatch(r"(Vector[234]i?|Rect2i?|Color)\([-\d., e]+\)", text) and plain != "Variant":
            return text
        if plain == "Variant" and re.fullmatch(r"-?\d+|true|false", text):
            return f"Variant({text})"
        raise Skip

    @staticmethod
    def argument_name(name):
        return "p_" + name

    def signature(self, method):
        """Return type, and for each argument its type, name and default (or None)."""
        returned = method.get("return_value")
        if returned is None and method.get("return_type"):
            returned = {"type": method["return_type"]}
        result = self.value_type(returned["type"], returned.get("meta")) if returned else "void"
        arguments = []
        for argument in method.get("arguments", []):
            cpp_type = self.argument_type(argument)
            default = self.default_value(argument, cpp_type) if "default_value" in argument else None
            arguments.append((cpp_type, self.argument_name(argument["name"]), default))
        return result, arguments

    @staticmethod
    def parameters(arguments, with_defaults):
        parts = []
        for cpp_type, name, default in arguments:
            space = "" if cpp_type.endswith(("*", "&")) else " "
            parts.append(f"{cpp_type}{space}{name}" + (f" = {default}" if with_defaults and default is not None else ""))
        return ", ".join(parts)

    @staticmethod
    def join_type(result, name):
        return f"{result}{name}" if result.endswith("*") else f"{result} {name}"

    @staticmethod
    def vararg(result, name, arguments, const, static=""):
        """A template that turns any arguments into Variants, and the function that it hands them to."""
        fixed = [f"const {t.removeprefix('const ').removesuffix(' &')} &{n}" for t, n, _ in arguments]
        names = [n for _, n, _ in arguments] + ["p_args..."]
        end = "" if result == "void" else "return "
        return (
            f"\ttemplate <typename... Args>\n"
            f"\t{static}{result} {name}({', '.join(fixed + ['const Args &...p_args'])}){const} {{\n"
            f"\t\tinternal::VariantArguments arguments({', '.join(names)});\n"
            f"\t\t{end}_{name}_variants(arguments.pointers.data(), int64_t(sizeof...(Args) + {len(arguments)}));\n"
            f"\t}}\n"
            f"\t{static}{result} _{name}_variants(const Variant **p_args, int64_t p_count){const};\n"
        )

    # --- Built-in types ----------------------------------------------------------------------------------------------

    def builtin_declarations(self):
        lines = ["#pragma once\n\nnamespace godot {\n"]
        lines += [f"class {name};" for name in OPAQUE_TYPES]
        lines.append("\n// Every type that a Variant can hold by value, with its number.\n#define GODOT_BUILTIN_TYPES(X) \\")
        entries = [f"\tX({name}, {self.type_number(name)})" for name in MATH_TYPES + OPAQUE_TYPES]
        lines.append(" \\\n".join(entries))
        lines.append("\n} // namespace godot\n")
        self.write("include/godot_cpp/variant/builtin_declarations.hpp", "\n".join(lines))

    def type_number(self, name):
        return self.enum_constant(name).removeprefix("TYPE_")

    def enum_constant(self, name):
        constants = {key.replace("TYPE_", "").replace("_", ""): key for key in self.types}
        return constants[name.upper()]

    def variant_enums(self):
        lines = ["enum Type {"]
        for name, value in self.types.items():
            lines.append(f"\t{name.removeprefix('TYPE_').replace('MAX', 'VARIANT_MAX')} = {value},")
        lines.append("};\n\nenum Operator {")
        for value in self.enums["Variant.Operator"]["values"]:
            lines.append(f"\t{value['name']} = {value['value']},")
        lines.append("};\n")
        self.write("include/godot_cpp/variant/variant_enums.inc", "\n".join(lines))

    def builtin_class(self, name):
        info = self.builtins[name]
        number = self.types[self.enum_constant(name)]
        element = PACKED_ELEMENTS.get(name)
        head = [
            f"class {name} {{", f"\talignas(8) uint8_t opaque[{self.sizes[name]}];\n", "public:",
            f"\t{name}();", f"\t{name}(const {name} &p_other);", f"\t{name}({name} &&p_other) noexcept;",
            f"\t~{name}();" if info["has_destructor"] else f"\t~{name}() = default;",
            f"\t{name} &operator=(const {name} &p_other);", f"\t{name} &operator=({name} &&p_other) noexcept;",
            "\tvoid *_native_ptr() { return opaque; }", "\tconst void *_native_ptr() const { return opaque; }",
        ]
        body = [
            f"{name}::{name}() {{ internal::construct({number}, 0, opaque); }}",
            f"{name}::{name}(const {name} &p_other) {{ internal::construct({number}, 1, opaque, p_other); }}",
            f"{name}::{name}({name} &&p_other) noexcept : {name}() {{ std::swap(opaque, p_other.opaque); }}",
            f"{name} &{name}::operator=(const {name} &p_other) {{\n\t{name} copy(p_other);\n"
            f"\tstd::swap(opaque, copy.opaque);\n\treturn *this;\n}}",
            f"{name} &{name}::operator=({name} &&p_other) noexcept {{\n\tstd::swap(opaque, p_other.opaque);\n"
            f"\treturn *this;\n}}",
        ]
        if info["has_destructor"]:
            body.append(
                f"{name}::~{name}() {{\n\tstatic const GDExtensionPtrDestructor destructor =\n\t\t\t"
                f"internal::api.variant_get_ptr_destructor(GDExtensionVariantType({number}));\n"
                f"\tdestructor(opaque);\n}}")
        for constructor in info["constructors"][2:]:
            try:
                _, arguments = self.signature(constructor)
            except Skip:
                continue
            names = "".join(f", {n}" for _, n, _ in arguments)
            head.append(f"\t{name}({self.parameters(arguments, True)});")
            body.append(f"{name}::{name}({self.parameters(arguments, False)}) {{\n"
                        f"\tinternal::construct({number}, {constructor['index']}, opaque{names});\n}}")
        for method in info.get("methods", []):
            self.builtin_method(name, number, method, head, body)
        self.builtin_comparisons(name, number, info, head, body)
        if element:
            self.packed_members(name, element, head, body)
        if name in EXTENDED_TYPES:
            head.append(f"#include <godot_cpp/variant/{snake_case(name)}_members.inc>")
        head.append("};\n")
        return "\n".join(head), "\n\n".join(body) + "\n"

    def builtin_method(self, name, number, method, head, body):
        if method["name"] in CPP_KEYWORDS:
            return
        try:
            result, arguments = self.signature(method)
        except Skip:
            return
        const = " const" if method["is_const"] else ""
        cached = f'static const internal::BuiltinMethod method({number}, "{method["name"]}", {method["hash"]});'
        if method["is_vararg"]:
            head.append(self.vararg(result, method["name"], arguments, const))
            place = "nullptr" if result == "void" else "&result"
            body.append(
                f"{result} {name}::_{method['name']}_variants(const Variant **p_args, int64_t p_count){const} {{\n\t{cached}\n"
                + ("" if result == "void" else f"\t{result} result;\n")
                + f"\tmethod.call_variants(opaque, p_args, p_count, {place});\n"
                + ("" if result == "void" else "\treturn result;\n") + "}")
            return
        static = method["is_static"]
        names = "".join(f", {n}" for _, n, _ in arguments)
        base = "nullptr" if static else "opaque"
        head.append(f"\t{'static ' if static else ''}{result} {method['name']}({self.parameters(arguments, True)}){const};")
        body.append(f"{result} {name}::{method['name']}({self.parameters(arguments, False)}){const} {{\n\t{cached}\n"
                    f"\treturn method.call<{result}>({base}{names});\n}}")

    @staticmethod
    def builtin_comparisons(name, number, info, head, body):
        for operator in info["operators"]:
            if operator.get("right_type") != name or operator["name"] not in ("==", "<"):
                continue
            code = {"==": 0, "<": 2}[operator["name"]]
            head.append(f"\tbool operator{operator['name']}(const {name} &p_other) const;")
            body.append(
                f"bool {name}::operator{operator['name']}(const {name} &p_other) const {{\n"
                f"\tstatic const GDExtensionPtrOperatorEvaluator evaluator = internal::api.variant_get_ptr_operator_evaluator(\n"
                f"\t\t\tGDExtensionVariantOperator({code}), GDExtensionVariantType({number}), GDExtensionVariantType({number}));\n"
                f"\treturn internal::compare(evaluator, opaque, p_other.opaque);\n}}")

    @staticmethod
    def packed_members(name, element, head, body):
        function = snake_case(name) + "_operator_index"
        head.append(
            f"\t{name}(std::initializer_list<{element}> p_values);\n"
            f"\t// Null when empty. The first change of an array that others share copies it.\n"
            f"\tconst {element} *ptr() const {{ return is_empty() ? nullptr : &(*this)[0]; }}\n"
            f"\t{element} *ptrw() {{ return is_empty() ? nullptr : &(*this)[0]; }}\n"
            f"\tconst {element} *begin() const {{ return ptr(); }}\n"
            f"\tconst {element} *end() const {{ return is_empty() ? nullptr : ptr() + size(); }}\n"
            f"\tconst {element} &operator[](int64_t p_index) const;\n"
            f"\t{element} &operator[](int64_t p_index);")
        body.append(
            f"{name}::{name}(std::initializer_list<{element}> p_values) : {name}() {{\n"
            f"\tresize(int64_t(p_values.size()));\n\tstd::copy(p_values.begin(), p_values.end(), ptrw());\n}}")
        body.append(f"const {element} &{name}::operator[](int64_t p_index) const {{\n"
                    f"\treturn *static_cast<const {element} *>(internal::api.{function}_const(opaque, p_index));\n}}")
        body.append(f"{element} &{name}::operator[](int64_t p_index) {{\n"
                    f"\treturn *static_cast<{element} *>(internal::api.{function}(opaque, p_index));\n}}")

    def builtin_types(self):
        heads, bodies = zip(*(self.builtin_class(name) for name in OPAQUE_TYPES))
        self.write("include/godot_cpp/variant/builtin_classes.hpp",
                   "#pragma once\n\n#include <godot_cpp/variant/variant.hpp>\n\nnamespace godot {\n\n" + "\n".join(heads)
                   + "\n} // namespace godot\n")
        self.write("src/builtin_types.cpp",
                   "#include <godot_cpp/core/engine_call.hpp>\n\n#include <algorithm>\n#include <utility>\n\n"
                   "namespace godot {\n\n" + "\n".join(bodies) + "\n} // namespace godot\n")
        for name in MATH_TYPES + OPAQUE_TYPES + ["BuiltinTypes"]:
            self.write(f"include/godot_cpp/variant/{snake_case(name)}.hpp",
                       "#pragma once\n\n#include <godot_cpp/variant/variant.hpp>\n")

    # --- Engine classes ----------------------------------------------------------------------------------------------

    @staticmethod
    def enum_body(enum, indent=""):
        lines = [f"{indent}enum {enum['name']} : int64_t {{"]
        lines += [f"{indent}\t{v['name']} = {v['value']}," for v in enum["values"]]
        return "\n".join(lines) + f"\n{indent}}};\n"

    def global_constants(self):
        text = "#pragma once\n\n#include <cstdint>\n\nnamespace godot {\n\n"
        text += "\n".join(self.enum_body(self.enums[name]) for name in GLOBAL_ENUMS)
        self.write("include/godot_cpp/classes/global_constants.hpp", text + "\n} // namespace godot\n")

    def engine_method(self, name, method, head, body, virtuals, used):
        if method["name"] in CPP_KEYWORDS:
            return
        try:
            result, arguments = self.signature(method)
        except Skip:
            return
        used.update(re.findall(r"\w+", " ".join([result] + [t for t, _, _ in arguments])))
        const = " const" if method["is_const"] else ""
        function = method["name"]
        if method["is_virtual"]:
            unnamed = ", ".join(t for t, _, _ in arguments)
            given = "" if result == "void" else " return {}; "
            head.append(f"\tvirtual {self.join_type(result, function)}({unnamed}){const} {{{given}}}")
            virtuals.append(
                f"\t\tif constexpr (!std::is_same_v<decltype(&B::{function}), decltype(&T::{function})>) {{\n"
                f"\t\t\tinternal::bind_virtual<&T::{function}>(T::get_class_static(), \"{function}\");\n\t\t}}")
            return
        cached = f'static const internal::EngineMethod method(get_class_static(), "{function}", {method["hash"]});'
        if method["is_vararg"]:
            head.append(self.vararg(result, function, arguments, const))
            end = "" if result == "void" else "return "
            call = "method.call_variants(_owner, p_args, p_count)"
            if result not in ("void", "Variant"):
                call = f"internal::TypeInfo<{result}>::from_variant({call})"
            body.append(f"{result} {name}::_{function}_variants(const Variant **p_args, int64_t p_count){const} {{\n"
                        f"\t{cached}\n\t{end}{call};\n}}")
            return
        static = method["is_static"]
        names = "".join(f", {n}" for _, n, _ in arguments)
        owner = "nullptr" if static else "_owner"
        head.append(f"\t{'static ' if static else ''}{self.join_type(result, function)}"
                    f"({self.parameters(arguments, True)}){const};")
        body.append(f"{self.join_type(result, name + '::' + function)}({self.parameters(arguments, False)}){const} {{\n"
                    f"\t{cached}\n\treturn method.call<{result}>({owner}{names});\n}}")

    def engine_class(self, name):
        info = self.classes[name]
        parent = info.get("inherits", "Wrapped")
        head, body, virtuals, used, casts = [], [], [], set(), []
        for enum in info.get("enums", []):
            head.append(self.enum_body(enum, "\t"))
            casts.append(f"VARIANT_ENUM_CAST({name}::{enum['name']})")
        for constant in info.get("constants", []):
            kind = "int" if -2**31 <= constant["value"] < 2**31 else "int64_t"
            head.append(f"\tstatic constexpr {kind} {constant['name']} = {constant['value']};")
        if name in self.singletons:
            head.append(f"\tstatic {name} *get_singleton();")
            body.append(f"{name} *{name}::get_singleton() {{\n"
                        f"\treturn static_cast<{name} *>(internal::get_singleton(get_class_static()));\n}}")
        if name == "Object":
            head.append(
                "\t// Null unless the object is a T.\n"
                "\ttemplate <typename T>\n\tstatic T *cast_to(Object *p_object) {\n\t\treturn dynamic_cast<T *>(p_object);\n\t}\n"
                "\ttemplate <typename T>\n\tstatic const T *cast_to(const Object *p_object) {\n"
                "\t\treturn dynamic_cast<const T *>(p_object);\n\t}")
        for method in info.get("methods", []):
            self.engine_method(name, method, head, body, virtuals, used)
        virtual_bodies = "\n".join([f"\t\t{parent}::register_virtuals<T, B>();"] + virtuals)
        head.append(f"\ttemplate <typename T, typename B>\n\tstatic void register_virtuals() {{\n{virtual_bodies}\n\t}}")
        ancestors = set()
        ancestor = info.get("inherits")
        while ancestor:
            ancestors.add(ancestor)
            ancestor = self.classes[ancestor].get("inherits")
        others = (used & set(self.classes)) - ancestors - {name}
        enum_owners = set()
        for method in info.get("methods", []):
            text = json.dumps(method)
            enum_owners |= set(re.findall(r"(?:enum|bitfield)::(\w+)\.", text)) & others
        if name == "Object":
            includes = ["classes/wrapped.hpp"]
        else:
            includes = [f"classes/{snake_case(parent)}.hpp"]
            if name != "RefCounted":
                includes += ["classes/ref.hpp", "core/method_bind.hpp"]
        includes += [f"classes/{snake_case(owner)}.hpp" for owner in sorted(enum_owners)]
        text = "#pragma once\n\n" + "".join(f"#include <godot_cpp/{i}>\n" for i in includes)
        text += "\n#include <type_traits>\n\nnamespace godot {\n\n"
        text += "".join(f"class {other};\n" for other in sorted(others - enum_owners))
        text += f"\nclass {name} : public {parent} {{\n\tGODOT_ENGINE_CLASS({name}, {parent})\n\n"
        text += "\n".join(head) + "\n};\n\n} // namespace godot\n"
        if casts and name not in ("Object", "RefCounted"):
            text += "\n" + "\n".join(casts) + "\n"
        self.write(f"include/godot_cpp/classes/{snake_case(name)}.hpp", text)
        return "\n\n".join(body) + "\n"

    def engine_classes(self):
        parts = [""] * 3
        for name in self.sorted_classes():
            body = self.engine_class(name)
            shortest = min(range(len(parts)), key=lambda i: len(parts[i]))
            parts[shortest] += "\n" + body
        includes = "".join(f"#include <godot_cpp/classes/{snake_case(n)}.hpp>\n" for n in sorted(self.classes))
        for number, part in enumerate(parts):
            self.write(f"src/engine_classes_{number}.cpp",
                       includes + "#include <godot_cpp/classes/engine_classes.hpp>\n"
                       "#include <godot_cpp/core/engine_call.hpp>\n#include <godot_cpp/variant/typed_array.hpp>\n\n"
                       "namespace godot {\n" + part + "\n} // namespace godot\n")
        table = "".join(f"\t\t{{{n}::get_class_static, &EngineBinding<{n}>::callbacks}},\n"
                        for n in reversed(self.sorted_classes()))
        self.write("src/engine_class_table.cpp",
                   includes + "#include <godot_cpp/classes/engine_classes.hpp>\n\nnamespace godot::internal {\n\n"
                   f"const std::array<EngineClass, {len(self.classes)}> engine_classes = {{{{\n{table}}}}};\n\n"
                   "} // namespace godot::internal\n")
        self.write("include/godot_cpp/classes/engine_classes.hpp",
                   "#pragma once\n\n#include <godot_cpp/classes/object.hpp>\n\n#include <array>\n\n"
                   "namespace godot::internal {\n\nstruct EngineClass {\n\tconst StringName &(*get_name)();\n"
                   "\tconst GDExtensionInstanceBindingCallbacks *callbacks;\n};\n\n"
                   "// The wrapped classes, children before their parents.\n"
                   f"extern const std::array<EngineClass, {len(self.classes)}> engine_classes;\n\n"
                   "// Wrapped until the extension is unloaded. Null when this engine has no such singleton.\n"
                   "Object *get_singleton(const StringName &p_name);\n\n} // namespace godot::internal\n")

    def utility_functions(self):
        head, body = [], []
        for function in self.utilities:
            if not function["is_vararg"] or function.get("return_type"):
                continue
            name = function["name"]
            head.append(self.vararg("void", name, [], "", "static "))
            body.append(f"void UtilityFunctions::_{name}_variants(const Variant **p_args, int64_t p_count) {{\n"
                        f'\tstatic const internal::UtilityFunction function("{name}", {function["hash"]});\n'
                        "\tfunction.call_variants(p_args, p_count, nullptr);\n}")
        self.write("include/godot_cpp/variant/utility_functions.hpp",
                   "#pragma once\n\n#include <godot_cpp/variant/variant.hpp>\n\nnamespace godot {\n\n"
                   "class UtilityFunctions {\npublic:\n" + "\n".join(head) + "};\n\n} // namespace godot\n")
        self.write("src/utility_functions.cpp",
                   "#include <godot_cpp/core/engine_call.hpp>\n#include <godot_cpp/variant/utility_functions.hpp>\n\n"
                   "namespace godot {\n\n" + "\n\n".join(body) + "\n\n} // namespace godot\n")

    def run(self):
        self.builtin_declarations()
        self.variant_enums()
        self.builtin_types()
        self.global_constants()
        self.engine_classes()
        self.utility_functions()


def main():
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    api = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    lines = (line.split("#")[0].strip() for line in Path(sys.argv[2]).read_text(encoding="utf-8").splitlines())
    Generator(api, [line for line in lines if line], Path(sys.argv[3])).run()


if __name__ == "__main__":
    main()
