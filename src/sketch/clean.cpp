#include "sketch/clean.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace treerec {

namespace {

// Of one line and of all together: no drawing by hand has as many, and the work grows with their square.
constexpr double kMostPoints = 2000.0, kMostPointsOfAll = 20000.0;

}  // namespace

FlatLine thin_line(const FlatLine& line, double least) {
    FlatLine kept;
    if (line.empty()) return kept;
    kept.push_back(line[0]);
    for (const DVec2& p : line)
        if (glm::length(p - kept.back()) >= least) kept.push_back(p);
    if (kept.back() != line.back()) kept.push_back(line.back());
    return kept;
}

FlatLine fill_line(const FlatLine& line, double most, double far, std::vector<bool>* pinned) {
    FlatLine filled;
    if (pinned) pinned->clear();
    bool far_before = false;
    for (size_t i = 0; i < line.size(); i++) {
        const double length = i + 1 < line.size() ? glm::length(line[i + 1] - line[i]) : 0.0;
        filled.push_back(line[i]);
        if (pinned) pinned->push_back(far_before && length > far);
        far_before = length > far;
        const int pieces = static_cast<int>(std::ceil(length / most));
        for (int k = 1; k < pieces; k++) {
            filled.push_back(line[i] + (static_cast<double>(k) / pieces) * (line[i + 1] - line[i]));
            if (pinned) pinned->push_back(false);
        }
    }
    return filled;
}

FlatLine smooth_line(const FlatLine& line, const std::vector<bool>& pinned) {
    constexpr std::array<double, 5> kWeights = {0.07, 0.13, 0.60, 0.13, 0.07};
    FlatLine smooth = line;
    for (size_t i = 2; i + 2 < line.size(); i++) {
        if (pinned[i]) continue;
        DVec2 sum(0.0);
        for (size_t k = 0; k < kWeights.size(); k++)
            sum += kWeights[k] * line[i + k - 2];
        smooth[i] = sum;
    }
    return smooth;
}

std::vector<FlatLine> clean_lines(std::span<const FlatLine> lines) {
    std::vector<FlatLine> cleaned;
    double all = 0.0;
    for (const FlatLine& line : lines) {
        cleaned.push_back(thin_line(line, kLeastSpacing));
        all += line_length(cleaned.back());
    }
    for (FlatLine& line : cleaned) {
        const double most = std::max({kMostSpacing, line_length(line) / kMostPoints, all / kMostPointsOfAll});
        if (most > kMostSpacing) line = thin_line(line, most * (kLeastSpacing / kMostSpacing));
        std::vector<bool> pinned;
        const FlatLine filled = fill_line(line, most, 1.25 * most, &pinned);
        line = smooth_line(filled, pinned);
        line.erase(std::unique(line.begin(), line.end()), line.end());
    }
    return cleaned;
}

}  // namespace treerec
