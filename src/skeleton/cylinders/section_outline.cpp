#include "skeleton/cylinders/section_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/linear_system.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kSectors = 36;
constexpr double kCovered = 0.7;         // of the directions
constexpr size_t kLeastOfSector = 2;     // points; one alone may be anything's
constexpr double kNearest = 0.3;         // radii from the axis: nearer points are no bark,
constexpr double kFarthest = 2.2;        // nor are farther ones
constexpr double kMostOffset = 0.5;      // radii: a middle farther from the axis is another thing's
constexpr double kMostAmplitudes = 1.5;  // of all harmonics together; more is no wood
constexpr int kRounds = 4;               // of finding the middle
constexpr int kReweightings = 10;
constexpr double kOff = 1e9;      // keeps a harmonic at 0
constexpr double kTukey = 4.685;  // 95 % efficiency for normal noise
constexpr double kMadToSigma = 1.4826;
constexpr double kRelief = 0.06;       // radii: ribs four times as high are still wood, not ivy on it
constexpr double kLeastScale = 0.005;  // radii: what bark varies by in any case
// Over the mean radius: how large a harmonic is before it is seen (scanned stems: .02 to .15). It keeps a gap
// between the points from swinging out.
constexpr double kUsual = 0.15;
constexpr size_t kOrders = SectionShape::kHarmonics + 1;  // with the first
constexpr size_t kTerms = 1 + 2 * kOrders;

struct Sector {
    double radius = 0.0;  // the median
    double weight = 0.0;  // 0: not seen
};
using Sectors = std::array<Sector, kSectors>;
using Terms = std::array<double, kTerms>;  // the mean, then cosine and sine by order

double middle_angle(size_t sector) {
    return 2.0 * kPi * (static_cast<double>(sector) + 0.5) / kSectors;
}

Terms terms_at(double angle) {
    Terms terms{1.0};
    for (size_t k = 1; k <= kOrders; k++) {
        terms[2 * k - 1] = portable::cos(static_cast<double>(k) * angle);
        terms[2 * k] = portable::sin(static_cast<double>(k) * angle);
    }
    return terms;
}

const std::array<Terms, kSectors>& sector_terms() {
    static const std::array<Terms, kSectors> all = [] {
        std::array<Terms, kSectors> made;
        for (size_t i = 0; i < kSectors; i++)
            made[i] = terms_at(middle_angle(i));
        return made;
    }();
    return all;
}

double value_of(const Terms& series, const Terms& at) {
    double sum = 0.0;
    for (size_t i = 0; i < kTerms; i++)
        sum += series[i] * at[i];
    return sum;
}

struct Fit {
    Terms series{};
    double variance = 0.0;  // of a sector's median about it
    double weights = 0.0;   // their sum,
    size_t seen = 0;        // and how many are not 0
};

Fit fit_series(const Sectors& sectors) {
    const std::array<Terms, kSectors>& terms = sector_terms();
    std::array<double, kSectors> trust;
    trust.fill(1.0);
    Fit fit;
    fit.variance = kLeastScale * kLeastScale;
    std::vector<double> off;
    for (int round = 0; round < kReweightings; round++) {
        std::array<Terms, kTerms> matrix{};
        Terms right{};
        for (size_t s = 0; s < kSectors; s++) {
            const double weight = sectors[s].weight * trust[s];
            for (size_t i = 0; i < kTerms && weight > 0.0; i++) {
                right[i] += weight * terms[s][i] * sectors[s].radius;
                for (size_t j = 0; j < kTerms; j++)
                    matrix[i][j] += weight * terms[s][i] * terms[s][j];
            }
        }
        // From the lowest order up: all at once would follow what lies off the wood before it is told from
        // it.
        const size_t known = 2 * static_cast<size_t>(round + 1);
        for (size_t i = 1; i < kTerms; i++)
            matrix[i][i] += i > known ? kOff : fit.variance / (kUsual * kUsual);
        if (!solve_linear(matrix, right, fit.series)) fit.series = {};
        off.clear();
        std::array<double, kSectors> residual{};
        for (size_t s = 0; s < kSectors; s++) {
            if (sectors[s].weight <= 0.0) continue;
            residual[s] = sectors[s].radius - value_of(fit.series, terms[s]);
            off.push_back(std::abs(residual[s]));
        }
        const double scale = std::max(kMadToSigma * quantile(off, 0.5), kRelief);
        double squares = 0.0;
        fit.weights = 0.0;
        fit.seen = 0;
        for (size_t s = 0; s < kSectors; s++) {
            if (sectors[s].weight <= 0.0) continue;
            const double t = residual[s] / (kTukey * scale);
            trust[s] = std::abs(t) < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0;
            squares += sectors[s].weight * trust[s] * residual[s] * residual[s];
            fit.weights += sectors[s].weight * trust[s];
            fit.seen += trust[s] > 0.0;
        }
        const double freedom = std::max(fit.weights - static_cast<double>(kTerms), 1.0);
        fit.variance = std::max(squares / freedom, kLeastScale * kLeastScale);
    }
    return fit;
}

// False where too few directions have points.
bool find_sectors(std::span<const DVec2> offsets, const DVec2& middle,
                  std::vector<std::pair<size_t, float>>& order, Sectors& sectors) {
    order.clear();
    for (const DVec2& offset : offsets) {
        const DVec2 from = offset - middle;
        const double distance = glm::length(from);
        if (distance < kNearest || distance > kFarthest) continue;
        const double turn = portable::atan2(from.y, from.x) / (2.0 * kPi);
        const auto sector = static_cast<size_t>((turn < 0.0 ? turn + 1.0 : turn) * kSectors);
        order.emplace_back(std::min(sector, kSectors - 1), static_cast<float>(distance));
    }
    std::sort(order.begin(), order.end());
    sectors = {};
    size_t seen = 0;
    for (size_t i = 0; i < order.size();) {
        size_t end = i;
        while (end < order.size() && order[end].first == order[i].first)
            end++;
        const size_t count = end - i;
        if (count >= kLeastOfSector) {
            const double low = order[i + (count - 1) / 2].second, high = order[i + count / 2].second;
            const double points = static_cast<double>(count);
            sectors[order[i].first] = {0.5 * (low + high), points / (points + 1.0)};
            seen++;
        }
        i = end;
    }
    return static_cast<double>(seen) >= kCovered * kSectors;
}

}  // namespace

std::optional<SectionShape> outline_of(std::span<const DVec2> offsets) {
    std::vector<std::pair<size_t, float>> order;
    Sectors sectors;
    DVec2 middle(0.0);
    Fit fit;
    for (int round = 0; round < kRounds; round++) {
        if (!find_sectors(offsets, middle, order, sectors)) return std::nullopt;
        fit = fit_series(sectors);
        if (round + 1 < kRounds) middle += DVec2(fit.series[1], fit.series[2]);
        if (glm::length(middle) > kMostOffset) return std::nullopt;
    }
    if (static_cast<double>(fit.seen) < kCovered * kSectors || !(fit.series[0] > kNearest))
        return std::nullopt;
    // A harmonic is twice a mean over the directions.
    const double error = 4.0 * fit.variance / fit.weights;
    SectionShape shape;
    double amplitudes = 0.0;
    for (size_t k = 0; k < SectionShape::kHarmonics; k++) {
        const double c = fit.series[2 * k + 3], s = fit.series[2 * k + 4];
        const double square = c * c + s * s;
        if (square <= error) continue;
        const double kept = (1.0 - error / square) / fit.series[0];
        shape.cosine[k] = static_cast<float>(kept * c);
        shape.sine[k] = static_cast<float>(kept * s);
        amplitudes += kept * std::sqrt(square);
    }
    if (amplitudes > kMostAmplitudes) return std::nullopt;
    return shape;
}

}  // namespace treerec
