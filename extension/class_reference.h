#pragma once

#include <string_view>
#include <vector>

// The text of every doc_classes/*.xml, for the editor's help. Written by the build.
extern const std::vector<std::string_view> kClassReference;
