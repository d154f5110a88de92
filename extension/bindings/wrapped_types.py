"""The engine's built-in types, as generate.py wraps them."""

# Laid out in C++ by math_types.hpp, not wrapped.
MATH_TYPES = [
    "Vector2", "Vector2i", "Rect2", "Rect2i", "Vector3", "Vector3i", "Transform2D", "Vector4", "Vector4i", "Plane",
    "Quaternion", "AABB", "Basis", "Transform3D", "Projection", "Color",
]
# In an order in which each may use the earlier ones in default arguments.
OPAQUE_TYPES = [
    "String", "StringName", "NodePath", "RID", "Callable", "Signal", "Dictionary", "Array", "PackedByteArray",
    "PackedInt32Array", "PackedInt64Array", "PackedFloat32Array", "PackedFloat64Array", "PackedStringArray",
    "PackedVector2Array", "PackedVector3Array", "PackedVector4Array", "PackedColorArray",
]
PACKED_ELEMENTS = {
    "PackedByteArray": "uint8_t", "PackedInt32Array": "int32_t", "PackedInt64Array": "int64_t",
    "PackedFloat32Array": "float", "PackedFloat64Array": "double", "PackedStringArray": "String",
    "PackedVector2Array": "Vector2", "PackedVector3Array": "Vector3", "PackedVector4Array": "Vector4",
    "PackedColorArray": "Color",
}
# Types whose hand-written members are in variant/NAME_members.inc.
EXTENDED_TYPES = ["String", "StringName", "NodePath", "Array", "Dictionary"]
GLOBAL_ENUMS = ["Error", "PropertyHint", "PropertyUsageFlags", "MethodFlags"]
NUMBERS = {
    "bool": "bool", "int": "int64_t", "float": "double", "int8": "int8_t", "int16": "int16_t", "int32": "int32_t",
    "int64": "int64_t", "uint8": "uint8_t", "uint16": "uint16_t", "uint32": "uint32_t", "uint64": "uint64_t",
    "double": "double", "char32": "char32_t", "char16": "char16_t",
}
