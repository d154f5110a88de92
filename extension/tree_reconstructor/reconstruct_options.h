#pragma once

#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/typed_array.hpp>

#include "pipeline/photos.h"
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

struct ParsedPhotoOptions {
    treerec::PhotosOptions pipeline;
    ParsedOptions tree;         // what of them a reconstruction of the cloud takes
    godot::Dictionary of_tree;  // as the user gave them
    godot::Dictionary of_photos;
};

// The options of TreeReconstructor::reconstruct_photos(): those above and some of its own. Throws as above.
ParsedPhotoOptions parse_photo_options(const godot::Dictionary& p_options);

// Its own alone.
godot::TypedArray<godot::Dictionary> list_photo_options();
