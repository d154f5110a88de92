#include "sketch/crown_sections.h"

#include <algorithm>
#include <cmath>

#include "error.h"

namespace treerec {

namespace {

constexpr size_t kRows = 1024;

}  // namespace

CrownSections::CrownSections(const std::vector<DVec2>& outline, bool square) : square_(square) {
    if (outline.size() < 3) throw Error("The crown's outline encloses nothing; draw it around the crown.");
    bottom_ = top_ = outline[0].y;
    left_ = right_ = outline[0].x;
    for (const DVec2& p : outline) {
        bottom_ = std::min(bottom_, p.y);
        top_ = std::max(top_, p.y);
        left_ = std::min(left_, p.x);
        right_ = std::max(right_, p.x);
    }
    if (!(top_ - bottom_ > 1e-9))
        throw Error("The crown's outline encloses nothing; draw it around the crown.");
    const double row_height = (top_ - bottom_) / kRows;
    std::vector<std::vector<double>> crossings(kRows);
    for (size_t i = 0; i < outline.size(); i++) {
        DVec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        if (a.y > b.y) std::swap(a, b);
        // Rows whose middle lies in [a.y, b.y).
        const auto first = static_cast<int64_t>(std::ceil((a.y - bottom_) / row_height - 0.5));
        const auto last = static_cast<int64_t>(std::ceil((b.y - bottom_) / row_height - 0.5));
        for (int64_t row = std::max<int64_t>(first, 0); row < std::min<int64_t>(last, kRows); row++) {
            const double y = bottom_ + (static_cast<double>(row) + 0.5) * row_height;
            crossings[static_cast<size_t>(row)].push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        }
    }
    rows_.reserve(kRows + 1);
    for (std::vector<double>& row : crossings) {
        rows_.push_back(static_cast<uint32_t>(sections_.size()));
        std::sort(row.begin(), row.end());
        for (size_t i = 0; i + 1 < row.size(); i += 2) {
            const double width = row[i + 1] - row[i];
            if (!(width > 0.0)) continue;
            sections_.push_back({row[i], row[i + 1]});
            reach_ = std::max(reach_, 0.5 * width);
            area_ += width * row_height;
            volume_ += (square_ ? width * width : 0.25 * kPi * width * width) * row_height;
        }
    }
    rows_.push_back(static_cast<uint32_t>(sections_.size()));
    if (sections_.empty()) throw Error("The crown's outline encloses nothing; draw it around the crown.");
}

std::span<const CrownSections::Section> CrownSections::at(double y) const {
    if (!(y >= bottom_ && y <= top_)) return {};
    const double where = (y - bottom_) / (top_ - bottom_) * kRows;
    const size_t row = std::min(static_cast<size_t>(where), kRows - 1);
    return {sections_.data() + rows_[row], rows_[row + 1] - rows_[row]};
}

bool CrownSections::encloses(double x, double y) const {
    for (const Section& section : at(y))
        if (x >= section.left && x <= section.right) return true;
    return false;
}

double CrownSections::half_depth(double x, double y) const {
    for (const Section& section : at(y)) {
        if (x < section.left || x > section.right) continue;
        const double half = 0.5 * (section.right - section.left);
        const double off = x - 0.5 * (section.left + section.right);
        return square_ ? half : std::sqrt(std::max(half * half - off * off, 0.0));
    }
    return -1.0;
}

bool CrownSections::contains(const DVec3& p, double margin) const {
    if (margin > 0.0) {
        // Above, below and on the slopes; the section tells of the sides.
        const double slant = std::sqrt(0.5) * margin;
        if (!(encloses(p.x, p.y + margin) && encloses(p.x, p.y - margin) &&
              encloses(p.x - slant, p.y + slant) && encloses(p.x + slant, p.y + slant) &&
              encloses(p.x - slant, p.y - slant) && encloses(p.x + slant, p.y - slant)))
            return false;
    }
    for (const Section& section : at(p.y)) {
        const double half = 0.5 * (section.right - section.left) - margin;
        const double off = p.x - 0.5 * (section.left + section.right);
        if (half < 0.0 || std::abs(off) > half) continue;
        if (square_ ? std::abs(p.z) <= half : off * off + p.z * p.z <= half * half) return true;
    }
    return false;
}

}  // namespace treerec
