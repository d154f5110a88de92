// Just as much of XML as drawings need: elements and their attributes, one after the other. No validation, no
// entities but the five that XML has and characters by number (so none that grows), text is skipped. Internal
// to sketch/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace treerec {

struct XmlTag {
    enum class Kind : unsigned char { kOpen, kClose, kEmpty };  // <g>, </g>, <g/>

    Kind kind = Kind::kOpen;
    std::string_view name;  // with its namespace's prefix: "svg:path"
    std::vector<std::pair<std::string_view, std::string>> attributes;  // decoded

    // The name without its prefix.
    std::string_view local_name() const { return name.substr(name.find(':') + 1); }
    // The attribute of that name, or nothing.
    const std::string* find(std::string_view attribute) const;
};

class XmlScan {
  public:
    // text: UTF-8, which must outlive this and its tags. who: the subject of what next() throws.
    XmlScan(std::string_view text, const std::string& who) : rest_(text), text_(text), who_(who) {}

    // The next element's beginning or end, or nothing at the end of the text. Throws Error where a tag, a
    // comment or the like is damaged or does not end.
    std::optional<XmlTag> next();

  private:
    [[noreturn]] void fail(const std::string& what) const;
    void skip_past(std::string_view end, const char* what);
    void skip_doctype();
    void skip_blanks();
    std::string_view take_name();
    std::string take_value();
    XmlTag take_tag();

    std::string_view rest_;
    std::string_view text_;
    const std::string& who_;
};

}  // namespace treerec
