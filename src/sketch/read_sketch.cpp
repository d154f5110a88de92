#include "sketch/read_sketch.h"

#include <cstdint>
#include <string_view>

#include "error.h"
#include "file_bytes.h"
#include "sketch/sketch_picture.h"

namespace treerec {

namespace {

enum class SketchFile : uint8_t { kJson, kSvg, kPicture };

using namespace std::string_view_literals;

// By what a file begins with.
SketchFile kind_of(std::string_view bytes, const std::string& who) {
    for (const std::string_view picture : {"\x89PNG"sv, "\xFF\xD8\xFF"sv, "BM"sv})
        if (bytes.starts_with(picture)) return SketchFile::kPicture;
    for (const std::string_view other :
         {"RIFF"sv, "GIF8"sv, "II*\0"sv, "MM\0*"sv, "8BPS"sv, "%PDF"sv, "gimp xcf"sv})
        if (bytes.starts_with(other))
            throw Error(who + " is a picture of a kind that can't be read here; save it as PNG or SVG.");
    if (bytes.size() > 8 && bytes.substr(4, 4) == "ftyp"sv)
        throw Error(who + " is a picture of a kind that can't be read here; save it as PNG or SVG.");
    if (bytes.starts_with("\x1F\x8B"sv))
        throw Error(who + " is compressed; save it as plain SVG, not as SVGZ.");
    if (bytes.starts_with("\xFF\xFE"sv) || bytes.starts_with("\xFE\xFF"sv))
        throw Error(who + " is text in UTF-16; save it as UTF-8.");
    const size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) throw Error(who + " is empty.");
    if (bytes[first] == '<') return SketchFile::kSvg;
    if (bytes[first] == '{') return SketchFile::kJson;
    throw Error(who +
                " is no sketch: neither a sketch's JSON, nor an SVG drawing, nor a PNG or JPEG picture.");
}

}  // namespace

Sketch read_sketch(const std::string& path, SketchOptions* options) {
    const std::string who = "'" + path + "'";
    const FileBytes file = read_file(path);
    std::string_view bytes = file.view();
    if (bytes.starts_with("\xEF\xBB\xBF"sv)) bytes.remove_prefix(3);
    switch (kind_of(bytes, who)) {
        case SketchFile::kSvg:
            return parse_sketch_svg(bytes, who);
        case SketchFile::kPicture:
            return parse_sketch_picture(bytes, who);
        case SketchFile::kJson:
            break;
    }
    return parse_sketch_json(bytes, who, options);
}

}  // namespace treerec
