#include "sketch/xml_scan.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "error.h"

namespace treerec {

namespace {

constexpr std::string_view kBlanks = " \t\r\n";
constexpr size_t kMostAttributes = 1000;

void append_utf8(std::string& out, uint32_t code) {
    const auto put = [&](uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0 | code >> 6U);
        put(0x80 | (code & 0x3FU));
    } else if (code < 0x10000) {
        put(0xE0 | code >> 12U);
        put(0x80 | (code >> 6U & 0x3FU));
        put(0x80 | (code & 0x3FU));
    } else {
        put(0xF0 | code >> 18U);
        put(0x80 | (code >> 12U & 0x3FU));
        put(0x80 | (code >> 6U & 0x3FU));
        put(0x80 | (code & 0x3FU));
    }
}

// What stands between & and ;, or false where it means nothing to us.
bool append_entity(std::string& out, std::string_view name) {
    constexpr std::pair<std::string_view, char> kNamed[] = {
        {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    for (const auto& [known, c] : kNamed)
        if (name == known) {
            out += c;
            return true;
        }
    if (name.size() < 2 || name.front() != '#') return false;
    const bool hex = name[1] == 'x';
    name.remove_prefix(hex ? 2 : 1);
    uint32_t code = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), code, hex ? 16 : 10);
    if (failure != std::errc() || end != name.data() + name.size() || code == 0 || code > 0x10FFFF)
        return false;
    append_utf8(out, code);
    return true;
}

bool begins_name(std::string_view text) {
    if (text.empty()) return true;  // it ends in the middle
    const char c = text.front();
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
           static_cast<unsigned char>(c) >= 0x80;
}

std::string decoded(std::string_view text) {
    constexpr size_t kLongest = 12;
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        const size_t plain = std::min(text.find('&'), text.size());
        out += text.substr(0, plain);
        text.remove_prefix(plain);
        if (text.empty()) break;
        const size_t end = text.substr(0, kLongest).find(';');
        if (end != std::string_view::npos && append_entity(out, text.substr(1, end - 1))) {
            text.remove_prefix(end + 1);
        } else {
            out += '&';
            text.remove_prefix(1);
        }
    }
    return out;
}

}  // namespace

const std::string* XmlTag::find(std::string_view attribute) const {
    for (const auto& [key, value] : attributes)
        if (key == attribute) return &value;
    return nullptr;
}

void XmlScan::fail(const std::string& what) const {
    const std::string_view before = text_.substr(0, text_.size() - rest_.size());
    throw Error(who_ + " is damaged: " + what + " (line " +
                std::to_string(std::count(before.begin(), before.end(), '\n') + 1) + ").");
}

std::optional<XmlTag> XmlScan::next() {
    while (true) {
        const size_t start = rest_.find('<');
        if (start == std::string_view::npos) return {};
        rest_.remove_prefix(start);
        if (rest_.starts_with("<!--")) {
            rest_.remove_prefix(4);
            skip_past("-->", "a comment");
        } else if (rest_.starts_with("<![CDATA[")) {
            skip_past("]]>", "a CDATA section");
        } else if (rest_.starts_with("<?")) {
            skip_past("?>", "a processing instruction");
        } else if (rest_.starts_with("<!")) {
            skip_doctype();
        } else if (begins_name(rest_.substr(rest_.starts_with("</") ? 2 : 1))) {
            return take_tag();
        } else {
            rest_.remove_prefix(1);  // of a text that should have written &lt;
        }
    }
}

void XmlScan::skip_past(std::string_view end, const char* what) {
    const size_t at = rest_.find(end);
    if (at == std::string_view::npos) fail(std::string(what) + " does not end");
    rest_.remove_prefix(at + end.size());
}

// With what it declares between [ and ].
void XmlScan::skip_doctype() {
    char quote = 0;
    bool inside = false;
    for (size_t i = 0; i < rest_.size(); i++) {
        const char c = rest_[i];
        if (quote != 0) {
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '[' || c == ']') {
            inside = c == '[';
        } else if (c == '>' && !inside) {
            rest_.remove_prefix(i + 1);
            return;
        }
    }
    fail("its document type does not end");
}

void XmlScan::skip_blanks() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
}

std::string_view XmlScan::take_name() {
    const size_t end = rest_.find_first_of(" \t\r\n=/><\"'");
    if (end == std::string_view::npos) fail("it ends in the middle of an element");
    const std::string_view name = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return name;
}

std::string XmlScan::take_value() {
    skip_blanks();
    if (rest_.empty() || (rest_.front() != '"' && rest_.front() != '\'')) fail("an attribute has no quotes");
    const size_t end = rest_.find(rest_.front(), 1);
    if (end == std::string_view::npos) fail("it ends in the middle of an attribute");
    std::string value = decoded(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return value;
}

XmlTag XmlScan::take_tag() {
    XmlTag tag;
    rest_.remove_prefix(1);
    if (rest_.starts_with('/')) {
        tag.kind = XmlTag::Kind::kClose;
        rest_.remove_prefix(1);
    }
    tag.name = take_name();
    while (true) {
        skip_blanks();
        if (rest_.empty()) fail("it ends in the middle of an element");
        if (rest_.front() == '>') {
            rest_.remove_prefix(1);
            return tag;
        }
        if (rest_.starts_with("/>")) {
            rest_.remove_prefix(2);
            tag.kind = XmlTag::Kind::kEmpty;
            return tag;
        }
        const std::string_view name = take_name();
        skip_blanks();
        if (name.empty() || !rest_.starts_with('=')) fail("an element's attributes cannot be told apart");
        if (tag.attributes.size() == kMostAttributes) fail("an element has more than 1000 attributes");
        rest_.remove_prefix(1);
        tag.attributes.emplace_back(name, take_value());
    }
}

}  // namespace treerec
