#include "exchange/foliage_lines.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "error.h"
#include "exchange/text_scan.h"

namespace treerec {

namespace {

constexpr std::string_view kHead = "# treerec foliage ";
constexpr std::string_view kCells = "# treerec leaves ";
constexpr size_t kHeadNumbers = 7;
constexpr size_t kCellsOfLine = 64;
constexpr double kMostMetres = 1e4;  // of any length

Error damaged(const std::string& path, const std::string& what) {
    return Error("'" + path + "' is damaged: its foliage " + what + ".");
}

// The numbers behind the words that a line begins with.
std::vector<double> numbers_of(std::string_view rest, const std::string& path) {
    std::vector<double> numbers;
    for (const std::string& field : split_fields(rest)) {
        const std::optional<double> value = parse_number(field);
        if (!value || !std::isfinite(*value)) throw damaged(path, "has a word that is no number");
        numbers.push_back(*value);
    }
    return numbers;
}

// A whole number from 0 to `most`.
template <class Number>
Number whole(double value, double most, const std::string& path) {
    if (!(value >= 0.0 && value <= most) || value != std::floor(value))
        throw damaged(path, "has a number that is out of bounds");
    return static_cast<Number>(value);
}

double metres(double value, const std::string& path) {
    if (!(std::abs(value) <= kMostMetres)) throw damaged(path, "has a length that is no tree's");
    return value;
}

}  // namespace

void append_foliage_lines(std::string& text, const Foliage& foliage, const DVec3& root) {
    if (foliage.empty()) return;
    text += kHead;
    for (int axis = 0; axis < 3; axis++) {
        append_number(text, foliage.origin[axis] - root[axis]);
        text += ' ';
    }
    append_number(text, foliage.edge);
    text += ' ';
    append_number(text, foliage.reach);
    text += foliage.colored ? " 1 " : " 0 ";
    append_number(text, static_cast<int64_t>(foliage.cells.size()));
    for (size_t i = 0; i < foliage.cells.size(); i++) {
        const FoliageCell& cell = foliage.cells[i];
        if (i % kCellsOfLine == 0) {
            text += '\n';
            text += kCells;
        } else {
            text += ' ';
        }
        append_number(text, int64_t{cell.x});
        for (const uint16_t number : {cell.y, cell.z, cell.points}) {
            text += ' ';
            append_number(text, int64_t{number});
        }
        if (!foliage.colored) continue;
        for (const uint8_t channel : cell.color) {
            text += ' ';
            append_number(text, int64_t{channel});
        }
    }
    text += '\n';
}

bool FoliageLines::read(std::string_view comment, const std::string& path) {
    if (comment.substr(0, kHead.size()) == kHead) {
        const std::vector<double> numbers = numbers_of(comment.substr(kHead.size()), path);
        if (numbers.size() != kHeadNumbers) throw damaged(path, "has too few or too many numbers");
        if (count_ > 0) throw damaged(path, "begins twice");
        for (int axis = 0; axis < 3; axis++)
            foliage_.origin[axis] = metres(numbers[static_cast<size_t>(axis)], path);
        foliage_.edge = metres(numbers[3], path);
        foliage_.reach = metres(numbers[4], path);
        foliage_.colored = whole<int>(numbers[5], 1.0, path) == 1;
        count_ = whole<size_t>(numbers[6], static_cast<double>(kMostFoliageCells), path);
        if (count_ == 0) throw damaged(path, "has no cell");
        return true;
    }
    if (comment.substr(0, kCells.size()) != kCells) return false;
    const std::vector<double> numbers = numbers_of(comment.substr(kCells.size()), path);
    const size_t each = foliage_.colored ? 7 : 4;
    if (numbers.size() % each != 0 || foliage_.cells.size() + numbers.size() / each > count_)
        throw damaged(path, "has too few or too many numbers");
    for (size_t at = 0; at < numbers.size(); at += each) {
        FoliageCell& cell = foliage_.cells.emplace_back();
        uint16_t* const fields[] = {&cell.x, &cell.y, &cell.z, &cell.points};
        for (size_t i = 0; i < 4; i++)
            *fields[i] = whole<uint16_t>(numbers[at + i], 65535.0, path);
        for (size_t i = 4; i < each; i++)
            cell.color[i - 4] = whole<uint8_t>(numbers[at + i], 255.0, path);
    }
    return true;
}

Foliage FoliageLines::take(const std::string& path) {
    if (foliage_.cells.size() != count_) throw damaged(path, "lacks cells; is the file cut off?");
    try {
        check_foliage(foliage_);
    } catch (const Error& error) {
        throw damaged(path, std::string("is none: ") + error.what());
    }
    count_ = 0;
    return std::exchange(foliage_, {});
}

}  // namespace treerec
