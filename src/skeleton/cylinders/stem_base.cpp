#include "skeleton/cylinders/stem_base.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr double kLowShare = 0.25;         // of the stem's length: the part that is looked at
constexpr double kClearOfStemBase = 0.12;  // of its length: where its radius can be trusted
constexpr double kUpright = 0.6;           // height over length of a stem that goes up,
constexpr double kUpRadii = 2.0;           // over so many radii
constexpr double kBentRadii = 2.0;         // radii more that are not trusted
constexpr double kSampleRadii = 6.0;       // radii: the stem that tells the line
constexpr size_t kLeastStations = 4;
constexpr double kMostCrooked = 0.4;     // radii: root mean square off the line
constexpr double kClearShare = 0.05;     // of the stem's length: from there on it stands clear of its base,
constexpr double kClearEnd = 0.15;       // and up to there it is about as thick
constexpr double kNextEnd = 0.3;         // of its length: what comes next
constexpr double kStemBaseRadii = 6.0;   // radii: the base's length at most
constexpr double kLeastStemBase = 0.75;  // of the stem's radius
constexpr double kMostStemBase = 2.0;
constexpr double kStemShare = 0.33;    // of the stem's radius: what is thinner at the root is a twig
constexpr double kRootSample = 2.0;    // radii: the stem that tells where it comes from,
constexpr double kSteep = 0.5;         // height over length of one that stands
constexpr double kMostRootMove = 2.0;  // radii
constexpr int kRounds = 3;             // of the fit, each without what the last one is far off
constexpr double kFarOff = 2.0;        // root mean squares

// x and z as linear functions of the height.
struct Line {
    double x = 0.0, z = 0.0, x_slope = 0.0, z_slope = 0.0;
    double spread = 0.0;  // root mean square distance, metres

    DVec3 at(double y) const { return {x + x_slope * y, y, z + z_slope * y}; }
    double off(const DVec3& p) const { return glm::distance(p, at(p.y)); }
};

std::optional<Line> fit_line(std::vector<DVec3> sample) {
    Line line;
    for (int round = 0; round < kRounds; round++) {
        if (sample.size() < kLeastStations) return std::nullopt;
        DVec3 mean(0.0);
        for (const DVec3& p : sample)
            mean += p / static_cast<double>(sample.size());
        double yy = 0.0, xy = 0.0, zy = 0.0;
        for (const DVec3& p : sample) {
            const DVec3 d = p - mean;
            yy += d.y * d.y;
            xy += d.x * d.y;
            zy += d.z * d.y;
        }
        if (!(yy > 0.0)) return std::nullopt;
        line.x_slope = xy / yy;
        line.z_slope = zy / yy;
        line.x = mean.x - line.x_slope * mean.y;
        line.z = mean.z - line.z_slope * mean.y;
        double sum = 0.0;
        for (const DVec3& p : sample)
            sum += line.off(p) * line.off(p);
        line.spread = std::sqrt(sum / static_cast<double>(sample.size()));
        const double limit = kFarOff * line.spread;
        std::erase_if(sample, [&](const DVec3& p) { return line.off(p) > limit; });
    }
    return line;
}

}  // namespace

void plant_stem_base(std::vector<Station>& stem) {
    std::vector<double> arc(stem.size(), 0.0);
    for (size_t i = 1; i < stem.size(); i++)
        arc[i] = arc[i - 1] + glm::distance(stem[i].position, stem[i - 1].position);
    std::vector<double> radii;
    for (size_t i = 0; i < stem.size() && arc[i] <= kLowShare * arc.back(); i++)
        if (stem[i].measured && arc[i] >= kClearOfStemBase * arc.back()) radii.push_back(stem[i].radius);
    if (radii.empty()) return;
    const double radius = quantile(radii, 0.5);
    // Where the stem starts to go up, and goes on so.
    const auto goes_up = [&](size_t i) {
        size_t j = i;
        while (j + 1 < stem.size() && arc[j] - arc[i] < kUpRadii * radius)
            j++;
        return stem[j].position.y - stem[i].position.y >= kUpright * (arc[j] - arc[i]);
    };
    size_t lowest = stem.size();
    for (size_t i = 0; i < stem.size() && arc[i] <= kLowShare * arc.back() + kUpRadii * radius; i++) {
        if (lowest < stem.size() && arc[i] - arc[lowest] > kUpRadii * radius) break;
        if (!goes_up(i))
            lowest = stem.size();
        else if (lowest == stem.size())
            lowest = i;
    }
    if (lowest == 0 || lowest == stem.size()) return;
    // The circles just above still lean to where the axis comes from.
    const double bent = arc[lowest] + kBentRadii * radius;
    while (lowest + 1 < stem.size() && arc[lowest] < bent)
        lowest++;
    std::vector<DVec3> sample;
    for (size_t i = lowest; i < stem.size() && arc[i] - arc[lowest] <= kSampleRadii * radius; i++)
        if (!stem[i].bridged) sample.push_back(stem[i].position);
    const std::optional<Line> line = fit_line(std::move(sample));
    if (!line || line->spread > kMostCrooked * radius) return;
    double ceiling = stem[lowest].position.y;
    for (size_t i = lowest; i-- > 0;) {
        // Each station stands below the one after it.
        ceiling = std::min(ceiling, stem[i].position.y);
        stem[i].position = line->at(ceiling);
    }
}

void limit_stem_base(std::vector<Station>& stem) {
    // The stem's radius, from where it stands clear of its own base.
    double arc = 0.0;
    std::vector<double> arcs(stem.size(), 0.0);
    for (size_t i = 1; i < stem.size(); i++)
        arcs[i] = arc += glm::distance(stem[i].position, stem[i - 1].position);
    const auto radius_between = [&](double low, double high) {
        std::vector<double> radii;
        for (size_t i = 0; i < stem.size(); i++)
            if (stem[i].measured && arcs[i] >= low * arc && arcs[i] <= high * arc)
                radii.push_back(stem[i].radius);
        return radii.size() < kLeastStations ? 0.0 : quantile(radii, 0.5);
    };
    const double radius = radius_between(kClearShare, kClearEnd);
    if (radius == 0.0) return;
    // The flare of a short stem reaches up to there; what is thinner is not its root, but the stem.
    const double next = radius_between(kClearEnd, kNextEnd);
    const double least = kLeastStemBase * (next > 0.0 && next < kLeastStemBase * radius ? next : radius);
    for (size_t i = 0; i < stem.size() && arcs[i] < kStemBaseRadii * radius; i++) {
        if (!stem[i].measured) continue;
        if (stem[i].radius < least) {
            stem[i].measured = false;
            stem[i].radius = 0.0;
        }
        stem[i].radius = std::min(stem[i].radius, kMostStemBase * radius);
    }
}

void seat_root(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    std::vector<Station>& stem = axes.front();
    if (stem.size() < 3 || stem[1].bridged || stem[2].bridged) return;
    const double radius = stem[1].radius;
    for (size_t l = 1; l < branches.size(); l++)
        if (branches[l].parent == 0 && branches[l].attach == 0 && !axes[l].empty() &&
            axes[l].front().radius >= kStemShare * radius)
            return;
    // From the first station that lies above it: below, the axis follows a spur.
    size_t first = 0;
    double reach = 0.0;
    DVec3 down(0.0);
    while (!(reach > 0.0)) {
        first++;
        if (first + 1 >= stem.size() || stem[first + 1].bridged) return;
        const DVec3 from = stem[first].position;
        size_t above = first + 1;
        while (above + 1 < stem.size() && !stem[above + 1].bridged &&
               glm::distance(stem[above].position, from) < kRootSample * radius)
            above++;
        down = normalized_or(from - stem[above].position, DVec3(0, -1, 0));
        const DVec3 offset = stem[0].position - from;
        if (glm::length(offset) > kMostRootMove * radius && first > 1) return;
        reach = -down.y >= kSteep ? offset.y / down.y : glm::dot(offset, down);
    }
    const DVec3 place = stem[first].position + reach * down;
    if (glm::distance(place, stem[0].position) > kMostRootMove * radius) return;
    for (size_t i = 0; i < first; i++)
        stem[i].position =
            place + (stem[first].position - place) * (static_cast<double>(i) / static_cast<double>(first));
}

}  // namespace treerec
