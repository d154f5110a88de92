// Panels on a sheet: see panels.h.
#include <algorithm>
#include <cmath>

#include "error.h"
#include "pipeline/lettering.h"
#include "pipeline/panels.h"

namespace treerec {

namespace {

constexpr int kMargin = 36;
constexpr int kGutter = 20;
constexpr int kCaption = 38;  // pixels of a caption below its panel
constexpr double kTitle = 19.0, kText = 10.5, kValue = 19.0, kNote = 9.0;
constexpr int kFigures = 74;  // pixels of the figures' height
constexpr int kNoteLine = 20;
constexpr Rgb kPaper = {246, 246, 242}, kWhite = {255, 255, 255}, kLine = {216, 219, 210};
constexpr Rgb kInk = {38, 50, 42}, kSoft = {104, 114, 106};

void fill(Image& image, int left, int top, int width, int height, const Rgb& color) {
    for (int y = std::max(top, 0); y < std::min(top + height, image.height); y++)
        for (int x = std::max(left, 0); x < std::min(left + width, image.width); x++)
            std::copy(color.begin(), color.end(), image.at(x, y));
}

void frame(Image& image, int left, int top, int width, int height) {
    fill(image, left - 1, top - 1, width + 2, height + 2, kLine);
    fill(image, left, top, width, height, kWhite);
}

// In the middle of what is free.
void put(Image& sheet, const Image& panel, int left, int top, int width, int height) {
    const int x0 = left + (width - panel.width) / 2, y0 = top + (height - panel.height) / 2;
    for (int y = 0; y < panel.height; y++)
        for (int x = 0; x < panel.width; x++) {
            const int at_x = x0 + x, at_y = y0 + y;
            if (at_x < left || at_y < top || at_x >= left + width || at_y >= top + height) continue;
            std::copy_n(panel.at(x, y), 3, sheet.at(at_x, at_y));
        }
}

void centred(Image& sheet, double middle, double y, const std::string& text, double size, const Rgb& color) {
    draw_text(sheet, middle - 0.5 * text_width(text, size), y, text, size, color);
}

std::vector<std::string> wrapped(const std::string& sentence, double size, double width) {
    std::vector<std::string> lines;
    std::string line;
    for (size_t at = 0; at < sentence.size();) {
        const size_t end = std::min(sentence.find(' ', at), sentence.size());
        const std::string word = sentence.substr(at, end - at);
        const std::string longer = line.empty() ? word : line + " " + word;
        if (!line.empty() && text_width(longer, size) > width) {
            lines.push_back(line);
            line = word;
        } else {
            line = longer;
        }
        at = end + 1;
    }
    if (!line.empty()) lines.push_back(line);
    return lines;
}

}  // namespace

Image lay_out(const Sheet& sheet) {
    size_t columns = 0;
    int width = 0;
    std::vector<int> heights;
    for (const std::vector<Panel>& row : sheet.rows) {
        columns = std::max(columns, row.size());
        heights.push_back(0);
        for (const Panel& panel : row) {
            width = std::max(width, panel.image.width);
            heights.back() = std::max(heights.back(), panel.image.height);
        }
    }
    if (width == 0) throw Error("A sheet without pictures shows nothing.");
    const int inner = static_cast<int>(columns) * (width + kGutter) - kGutter;
    const int top = kMargin + (sheet.title.empty() ? 0 : 68);
    std::vector<std::string> notes;
    for (const std::string& note : sheet.notes)
        for (std::string& line : wrapped(note, kNote, inner))
            notes.push_back(std::move(line));
    // As many figures beside each other as there is room for, and as many in every line.
    double widest = 1.0;
    for (const SheetFigure& figure : sheet.figures)
        widest = std::max({widest, text_width(figure.name, kNote), text_width(figure.value, kValue)});
    const size_t count = sheet.figures.size();
    const size_t room = std::max<size_t>(1, static_cast<size_t>(inner / (widest + kGutter)));
    const size_t lines = (count + room - 1) / room;
    const size_t beside = lines > 0 ? (count + lines - 1) / lines : 1;
    const int figures = static_cast<int>(lines) * kFigures;
    int height = top;
    for (const int row : heights)
        height += row + kCaption;
    if (count > 0) height += figures + kGutter;
    height += static_cast<int>(notes.size()) * kNoteLine + kMargin - (notes.empty() ? 8 : 4);
    Image image(inner + 2 * kMargin, height, 3);
    fill(image, 0, 0, image.width, image.height, kPaper);
    if (!sheet.title.empty()) {
        draw_text(image, kMargin, kMargin + kTitle, sheet.title, kTitle, kInk);
        draw_text(image, kMargin, kMargin + kTitle + 27.0, sheet.subtitle, kText, kSoft);
    }
    int y = top;
    for (size_t r = 0; r < sheet.rows.size(); r++) {
        int x = kMargin;
        for (const Panel& panel : sheet.rows[r]) {
            frame(image, x, y, width, heights[r]);
            put(image, panel.image, x, y, width, heights[r]);
            centred(image, x + 0.5 * width, y + heights[r] + 22.0, panel.caption, kText, kInk);
            x += width + kGutter;
        }
        y += heights[r] + kCaption;
    }
    if (count > 0) {
        frame(image, kMargin, y, inner, figures);
        for (size_t i = 0; i < count; i++) {
            const double middle =
                kMargin + inner * (static_cast<double>(i % beside) + 0.5) / static_cast<double>(beside);
            const double line = y + static_cast<double>(i / beside) * kFigures;
            centred(image, middle, line + 35.0, sheet.figures[i].value, kValue, kInk);
            centred(image, middle, line + 58.0, sheet.figures[i].name, kNote, kSoft);
        }
        y += figures + kGutter;
    }
    for (const std::string& note : notes) {
        draw_text(image, kMargin, y + 8.0, note, kNote, kSoft);
        y += kNoteLine;
    }
    return image;
}

}  // namespace treerec
