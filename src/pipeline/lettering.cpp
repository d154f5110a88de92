#include "pipeline/lettering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

namespace {

constexpr double kCapital = 6.0;  // units of a capital's height
constexpr double kSpacing = 1.7;  // units between letters
constexpr double kBlank = 2.4;    // units of a blank's width
constexpr double kStroke = 0.8;   // units
constexpr int kSteps = 6;         // of a curve's piece

// A letter's strokes, apart by blanks: what kind of line, then its places as pairs of digits, x to the right
// and y down from a capital's top: 6 is the baseline, 2 the top of a small letter, 8 the end of its tail.
// '-': straight pieces; '~': a quadratic B-spline from the first place to the last; 'o': a closed one.
struct Glyph {
    char letter;
    std::string_view strokes;
};

constexpr Glyph kGlyphs[] = {
    {'A', "-062046 -1434"},
    {'B', "-0600 ~002040432303 ~032343462606"},
    {'C', "~414000064645"},
    {'D', "-0600 ~002040462606"},
    {'E', "-40000646 -0333"},
    {'F', "-400006 -0333"},
    {'G', "~414000064643 -4323"},
    {'H', "-0006 -4046 -0343"},
    {'I', "-0006"},
    {'J', "~3035360604"},
    {'K', "-0006 -0440 -1346"},
    {'L', "-000646"},
    {'M', "-0600244046"},
    {'N', "-06004640"},
    {'O', "o00404606"},
    {'P', "-0600 ~002040432303"},
    {'Q', "o00404606 -3446"},
    {'R', "-0600 ~002040432303 -2346"},
    {'S', "~4140000343460605"},
    {'T', "-0040 -2026"},
    {'U', "~000406464440"},
    {'V', "-002640"},
    {'W', "-0016223640"},
    {'X', "-0046 -4006"},
    {'Y', "-002340 -2326"},
    {'Z', "-00400646"},
    {'a', "o02323606 -3236"},
    {'b', "-0006 o02323606"},
    {'c', "~333202063635"},
    {'d', "-3036 o02323606"},
    {'e', "~343202063635 -0434"},
    {'f', "~30101216 -0222"},
    {'g', "o02323606 ~3237380807"},
    {'h', "-0006 ~0402323436"},
    {'i', "-0206 -0000"},
    {'j', "~12171808 -1010"},
    {'k', "-0006 -0532 -1436"},
    {'l', "-0006"},
    {'m', "-0206 ~0402323436 ~3432626466"},
    {'n', "-0206 ~0402323436"},
    {'o', "o02323606"},
    {'p', "-0208 o02323606"},
    {'q', "-3238 o02323606"},
    {'r', "-0206 ~040222"},
    {'s', "~3332020434360605"},
    {'t', "~10151636 -0222"},
    {'u', "~0204063634 -3236"},
    {'v', "-022642"},
    {'w', "-0216233642"},
    {'x', "-0236 -3206"},
    {'y', "-0226 -4218"},
    {'z', "-02320636"},
    {'0', "o00303606"},
    {'1', "-022026"},
    {'2', "~0100303306 -0636"},
    {'3', "~0100303313 ~1333360605"},
    {'4', "-36300444"},
    {'5', "-300003 ~032232360605"},
    {'6', "o03333606 ~30000305"},
    {'7', "-003016"},
    {'8', "o00303303 o03333606"},
    {'9', "o00303303 ~31333606"},
    {'.', "-0606"},
    {',', "-1607"},
    {':', "-0303 -0606"},
    {';', "-1313 -1607"},
    {'-', "-0424"},
    {'+', "-0444 -2226"},
    {'=', "-0343 -0545"},
    {'%', "-4006 o00202202 o24444626"},
    {'(', "~20000626"},
    {')', "~00202606"},
    {'/', "-3006"},
    {'_', "-0747"},
    {'\'', "-0001"},
    {'<', "-320436"},
    {'>', "-023406"},
    {'?', "~0100303314 -1616"},
};

using Line = std::vector<DVec2>;

struct Letter {
    std::vector<Line> lines;  // in units
    double width = 0.0;
};

void add_curve(Line& line, const DVec2& from, const DVec2& control, const DVec2& to) {
    for (int i = 1; i <= kSteps; i++) {
        const double t = static_cast<double>(i) / kSteps;
        line.push_back((1.0 - t) * (1.0 - t) * from + 2.0 * t * (1.0 - t) * control + t * t * to);
    }
}

Line line_of(char kind, const Line& places) {
    if (kind == '-') return places;
    const auto middle = [](const DVec2& a, const DVec2& b) { return 0.5 * (a + b); };
    Line line;
    const size_t count = places.size();
    if (kind == 'o') {
        DVec2 last = middle(places.back(), places.front());
        line.push_back(last);
        for (size_t i = 0; i < count; i++) {
            const DVec2 next = middle(places[i], places[(i + 1) % count]);
            add_curve(line, last, places[i], next);
            last = next;
        }
        return line;
    }
    DVec2 last = places.front();
    line.push_back(last);
    for (size_t i = 1; i + 1 < count; i++) {
        const DVec2 next = i + 2 < count ? middle(places[i], places[i + 1]) : places.back();
        add_curve(line, last, places[i], next);
        last = next;
    }
    return line;
}

Letter letter_of(std::string_view strokes) {
    Letter letter;
    for (size_t at = 0; at < strokes.size(); at++) {
        const char kind = strokes[at++];
        Line places;
        for (; at + 1 < strokes.size() && strokes[at] != ' '; at += 2)
            places.emplace_back(strokes[at] - '0', strokes[at + 1] - '0');
        letter.lines.push_back(line_of(kind, places));
        for (const DVec2& place : letter.lines.back())
            letter.width = std::max(letter.width, place.x);
    }
    return letter;
}

const Letter& find_letter(char letter) {
    static const std::array<Letter, 128> letters = [] {
        std::array<Letter, 128> made;
        const Letter unknown = letter_of(std::end(kGlyphs)[-1].strokes);
        made.fill(unknown);
        for (const Glyph& glyph : kGlyphs)
            made[static_cast<size_t>(glyph.letter)] = letter_of(glyph.strokes);
        made[' '] = {{}, kBlank};
        return made;
    }();
    const auto code = static_cast<unsigned char>(letter);
    return letters[code < 128 ? code : '?'];
}

// The bytes that go on a character of UTF-8 are no characters.
bool goes_on(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

double away_from(const DVec2& p, const DVec2& from, const DVec2& to) {
    const DVec2 way = to - from;
    const double square = glm::dot(way, way);
    const double t = square > 0.0 ? std::clamp(glm::dot(p - from, way) / square, 0.0, 1.0) : 0.0;
    return glm::length(p - from - t * way);
}

// left, top: of the letter's grid, in pixels; unit: pixels.
void draw_letter(Image& image, double left, double top, const Letter& letter, double unit, const Rgb& color) {
    const size_t channels = image.channels < 3 ? 1 : 3;
    const double half = 0.5 * std::max(kStroke * unit, 1.0);
    const int x0 = std::max(0, static_cast<int>(std::floor(left - half - 1.0)));
    const int x1 =
        std::min(image.width - 1, static_cast<int>(std::ceil(left + letter.width * unit + half + 1.0)));
    const int y0 = std::max(0, static_cast<int>(std::floor(top - half - 1.0)));
    const int y1 = std::min(image.height - 1, static_cast<int>(std::ceil(top + 8.0 * unit + half + 1.0)));
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            const DVec2 p = (DVec2(x + 0.5, y + 0.5) - DVec2(left, top)) / unit;
            double nearest = 1e9;
            for (const Line& line : letter.lines)
                for (size_t i = 0; i < line.size(); i++)
                    nearest = std::min(nearest, away_from(p, line[i > 0 ? i - 1 : 0], line[i]));
            const double ink = std::clamp(0.5 + half - nearest * unit, 0.0, 1.0);
            uint8_t* pixel = image.at(x, y);
            for (size_t k = 0; k < channels; k++)
                pixel[k] = static_cast<uint8_t>(std::lround((1.0 - ink) * pixel[k] + ink * color[k]));
        }
}

}  // namespace

double text_width(std::string_view text, double size) {
    double units = 0.0;
    bool any = false;
    for (const char letter : text) {
        if (goes_on(letter)) continue;
        units += find_letter(letter).width + (any ? kSpacing : 0.0);
        any = true;
    }
    return units * size / kCapital;
}

void draw_text(Image& image, double x, double y, std::string_view text, double size, const Rgb& color) {
    const double unit = size / kCapital;
    for (const char letter : text) {
        if (goes_on(letter)) continue;
        const Letter& shape = find_letter(letter);
        draw_letter(image, x, y - size, shape, unit, color);
        x += (shape.width + kSpacing) * unit;
    }
}

}  // namespace treerec
