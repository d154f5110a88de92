#include "pipeline/html_parts.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "exchange/material_textures.h"
#include "pipeline/histogram_svg.h"

namespace treerec {

namespace {

std::string base64(const std::vector<uint8_t>& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(bytes.size() / 3 * 4 + 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = std::min<size_t>(3, bytes.size() - i);
        uint32_t value = 0;
        for (size_t k = 0; k < 3; k++)
            value = value << 8 | (k < left ? bytes[i + k] : 0U);
        for (size_t k = 0; k < 4; k++)
            text += k <= left ? kDigits[value >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

}  // namespace

const char* page_style() {
    return R"css(
:root{--ink:#26302a;--soft:#6b756d;--line:#dfe4dd;--paper:#fff;--ground:#f3f5f1;--accent:#3d6b46}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
main{max-width:1120px;margin:0 auto;padding:32px 24px 48px}
h1{font-size:28px;line-height:1.2;margin:0 0 4px;overflow-wrap:anywhere}
h2{font-size:18px;margin:0 0 12px}
p{margin:0 0 12px;max-width:72ch}
.soft{color:var(--soft)}
section{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:20px 22px;margin-top:20px}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(128px,1fr));gap:12px;margin-top:20px}
.tile{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:12px 14px}
.tile b{display:block;font-size:22px;line-height:1.25;font-variant-numeric:tabular-nums}
.tile span{color:var(--soft);font-size:13px}
.row{display:flex;flex-wrap:wrap;gap:12px;justify-content:space-evenly;align-items:flex-end}
figure{margin:0;text-align:center;flex:0 1 auto;min-width:0}
.two figure{max-width:48%}
figure img{max-width:100%;height:auto;display:block;margin:0 auto}
.four figure{flex:1 1 200px;max-width:25%}
figcaption{color:var(--soft);font-size:13px;margin-top:4px}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(380px,1fr));gap:20px}
.scroll{overflow-x:auto}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums;font-size:14px}
th{font-weight:600;color:var(--soft);font-size:13px}
th,td{text-align:right;padding:5px 10px;border-bottom:1px solid var(--line);white-space:nowrap}
th:first-child,td:first-child{text-align:left;padding-left:0}
.words{text-align:left;white-space:normal;padding-left:28px}
tr.sum td{font-weight:600;border-bottom:0}
.bar{display:inline-block;width:64px;height:8px;border-radius:4px;background:var(--line);margin-left:8px;vertical-align:middle}
.bar i{display:block;height:8px;border-radius:4px;background:var(--accent)}
details summary{cursor:pointer;color:var(--soft);font-size:14px;margin:0 0 8px}
.wide{max-width:100%}
.warn{border-color:#e0b64c;background:#fdf7e3}
.warn ul{margin:0;padding-left:20px}
svg{width:100%;height:auto;display:block}
svg text{font:11px system-ui,sans-serif;fill:var(--soft)}
svg .grid{stroke:var(--line)}
.key{display:flex;flex-wrap:wrap;gap:4px 14px;font-size:13px;color:var(--soft);margin-top:8px}
.key i{display:inline-block;width:11px;height:11px;border-radius:2px;margin-right:5px;vertical-align:-1px}
.heat{max-width:420px;margin:14px auto 0}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 18px;margin:0;font-size:14px}
dt{color:var(--soft)}dd{margin:0;overflow-wrap:anywhere}
@media(max-width:640px){main{padding:20px 12px}.four figure{max-width:48%;flex-basis:140px}.pair{grid-template-columns:1fr}}
@media print{body{background:#fff}section,.tile{break-inside:avoid}}
)css";
}

std::string words(const std::string& text) {
    using Json = nlohmann::json;
    const std::string clean =
        Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
    std::string out;
    for (char c : clean) {
        switch (c) {
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '&':
                out += "&amp;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string figure(const Image& image, const std::string& caption) {
    return "<figure><img width=\"" + std::to_string(image.width) + "\" height=\"" +
           std::to_string(image.height) + "\" alt=\"" + caption + "\" src=\"data:image/png;base64," +
           base64(encode_png(image)) + "\"><figcaption>" + caption + "</figcaption></figure>";
}

std::string percent(double share) {
    return fixed(100.0 * share, 1) + " %";
}

std::string millimetres(double metres) {
    return fixed(1000.0 * metres, 1);
}

std::string with_bar(double share) {
    return percent(share) +
           "<span class=\"bar\"><i style=\"width:" + fixed(100.0 * std::clamp(share, 0.0, 1.0), 1) +
           "%\"></i></span>";
}

std::string cells(std::initializer_list<std::string> values, const char* tag) {
    std::string row;
    for (const std::string& value : values)
        row += "<" + std::string(tag) + ">" + value + "</" + tag + ">";
    return row;
}

std::string tile(const std::string& value, const std::string& name) {
    return "<div class=\"tile\"><b>" + value + "</b><span>" + name + "</span></div>";
}

}  // namespace treerec
