#pragma once

#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/typed_array.hpp>

#include "pipeline/reconstruct.h"

struct ParsedOptions {
    treerec::ReconstructOptions pipeline;
    godot::String leaves;  // a leaf preset's name
};

// The options of TreeReconstructor::reconstruct_file() as a user may leave them out. Throws treerec::Error,
// naming the option, for an unknown one and for a value that can't be.
ParsedOptions parse_reconstruct_options(const godot::Dictionary& p_options);

// One entry per option: name, type, default, hint, hint_string (these as PropertyInfo has them) and
// description.
godot::TypedArray<godot::Dictionary> list_reconstruct_options();
