// Measured sections in the comments of a tree file. Internal to exchange/.
//
// A line each: "# treerec section NODE C2 S2 C3 S3 C4 S4 C5 S5", where NODE is the node's place in the file,
// from 0, and the rest is its SectionShape.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tree/tree.h"

namespace treerec {

struct FileSection {
    size_t node;
    SectionShape shape;
};

// Of the tree's nodes in depth-first order.
void append_section_lines(std::string& text, const Tree& tree);

// Whether the comment tells of a section, which is added. Throws Error where it is damaged; `path` is for the
// sentence.
bool read_section_line(std::string_view comment, std::vector<FileSection>& sections, const std::string& path);

// Gives them to the tree, whose ids are places in the file. Throws Error for a node that there is not.
void put_sections(const std::vector<FileSection>& sections, Tree& tree, const std::string& path);

}  // namespace treerec
