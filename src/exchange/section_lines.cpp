#include "exchange/section_lines.h"

#include <cmath>

#include "error.h"
#include "exchange/text_scan.h"

namespace treerec {

namespace {

constexpr std::string_view kBegin = "# treerec section ";
constexpr size_t kFields = 3;  // before the node's place

Error damaged(const std::string& path, const std::string& what) {
    return Error("'" + path + "' is damaged: the section of a node " + what + ".");
}

// The shortest decimal that reads back as the same float.
void append_float(std::string& text, float value) {
    char buffer[24];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    text += ' ';
    text.append(buffer, result.ptr);
}

}  // namespace

void append_section_lines(std::string& text, const Tree& tree) {
    int64_t place = 0;
    for (const NodeId id : tree.depth_first()) {
        if (const SectionShape* const shape = tree.section_of(id)) {
            text += kBegin;
            append_number(text, place);
            for (size_t i = 0; i < SectionShape::kHarmonics; i++) {
                append_float(text, shape->cosine[i]);
                append_float(text, shape->sine[i]);
            }
            text += '\n';
        }
        place++;
    }
}

bool read_section_line(std::string_view comment, std::vector<FileSection>& sections,
                       const std::string& path) {
    if (comment.substr(0, kBegin.size()) != kBegin) return false;
    const std::vector<std::string> fields = split_fields(comment);
    if (fields.size() != kFields + 1 + 2 * SectionShape::kHarmonics)
        throw damaged(path, "has too few or too many numbers");
    const std::optional<double> node = parse_number(fields[kFields]);
    if (!node || !(*node >= 0.0 && *node <= kLargestId) || *node != std::floor(*node))
        throw damaged(path, "names no node");
    FileSection& section = sections.emplace_back();
    section.node = static_cast<size_t>(*node);
    for (size_t i = 0; i < 2 * SectionShape::kHarmonics; i++) {
        const std::optional<double> value = parse_number(fields[kFields + 1 + i]);
        if (!value || !(std::abs(*value) <= kLargestHarmonic)) throw damaged(path, "is no outline of wood");
        (i % 2 == 0 ? section.shape.cosine : section.shape.sine)[i / 2] = static_cast<float>(*value);
    }
    return true;
}

void put_sections(const std::vector<FileSection>& sections, Tree& tree, const std::string& path) {
    if (sections.size() > kMostSections) throw damaged(path, "is one of too many");
    std::vector<SectionShape> shapes;
    for (const FileSection& section : sections) {
        if (!tree.contains(static_cast<NodeId>(section.node))) throw damaged(path, "names no node");
        shapes.push_back(section.shape);
    }
    const size_t before = tree.add_sections(shapes);
    for (size_t i = 0; i < sections.size(); i++)
        tree.set_section(static_cast<NodeId>(sections[i].node), before + i + 1);
}

}  // namespace treerec
