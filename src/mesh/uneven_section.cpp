#include "mesh/uneven_section.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {

namespace {

// Over the radius. Sections of scanned stems without buttresses vary by 7 % and more from their narrowest to
// their widest; these do by about 6.
constexpr std::array<double, 3> kAmplitudes = {0.018, 0.009, 0.005};
constexpr double kDrift = 0.12;     // radians per radius along, of the second harmonic, at most
constexpr double kLeadRadii = 2.5;  // over which it begins and ends
// Over the mean radius: buttresses of scanned trees reach as far, and further in wood would come apart. The
// last tenths are approached slowly.
constexpr double kLeast = 0.4, kMost = 2.2;
constexpr double kSoft = 0.3;

// Within kLeast .. kMost, and smooth; slope: what a change of the value becomes.
double limited(double value, double& slope) {
    const bool over = value > 1.0;
    const double bound = over ? kMost : kLeast;
    const double begin = over ? kMost - kSoft : kLeast + kSoft;
    const double past = over ? value - begin : begin - value;
    slope = 1.0;
    if (past <= 0.0) return value;
    slope = kSoft / (kSoft + past) * (kSoft / (kSoft + past));
    const double left = kSoft * kSoft / (kSoft + past);
    return over ? bound - left : bound + left;
}

}  // namespace

double UnevenSection::prior(double along, double angle, Of what) const {
    const double lead = section_lead(radius);
    if (along <= from || along >= until) return 0.0;
    const double whole = glm::smoothstep(0.0, lead, std::min(along - from, until - along));
    double sum = 0.0;
    for (size_t i = 0; i < kAmplitudes.size(); i++) {
        const double order = static_cast<double>(i + 2);
        const double phase = order * angle + phases[i] + drifts[i] * along;
        sum += kAmplitudes[i] * (what == Of::kTurn ? -order * portable::sin(phase) : portable::cos(phase));
    }
    return whole * sum;
}

RingOutline UnevenSection::outline_at(double along) const {
    const auto above = std::upper_bound(rings.begin(), rings.end(), along,
                                        [](double at, const RingOutline& ring) { return at < ring.along; });
    if (above == rings.begin()) return rings.front();
    if (above == rings.end()) return rings.back();
    const RingOutline &low = above[-1], &high = *above;
    const double t = (along - low.along) / std::max(high.along - low.along, 1e-30);
    RingOutline ring{along, glm::mix(low.share, high.share, t)};
    for (size_t i = 0; i < ring.cosine.size(); i++) {
        ring.cosine[i] = glm::mix(low.cosine[i], high.cosine[i], t);
        ring.sine[i] = glm::mix(low.sine[i], high.sine[i], t);
    }
    return ring;
}

double UnevenSection::sum_at(double along, double angle, Of what) const {
    if (rings.empty()) return prior(along, angle, what);
    const RingOutline ring = outline_at(along);
    double sum = (1.0 - ring.share) * prior(along, angle, what);
    for (size_t i = 0; i < ring.cosine.size(); i++) {
        const double order = static_cast<double>(i + 2);
        const double c = portable::cos(order * angle), s = portable::sin(order * angle);
        sum += what == Of::kTurn ? order * (ring.sine[i] * c - ring.cosine[i] * s)
                                 : ring.cosine[i] * c + ring.sine[i] * s;
    }
    return sum;
}

double UnevenSection::factor(double along, double angle) const {
    double slope;
    return limited(1.0 + sum_at(along, angle, Of::kRadius), slope);
}

double UnevenSection::turn(double along, double angle) const {
    double slope = 1.0;
    if (is_measured()) limited(1.0 + sum_at(along, angle, Of::kRadius), slope);
    return slope * sum_at(along, angle, Of::kTurn);
}

double UnevenSection::rise(double along, double angle) const {
    if (!is_measured()) return 0.0;  // the prior's is too little to be seen
    const double step = 0.25 * radius;
    return (factor(along + step, angle) - factor(along - step, angle)) / (2.0 * step);
}

UnevenSection uneven_section(uint64_t seed, double radius, double from, double until) {
    UnevenSection section;
    if (until <= from) return section;
    section.from = from;
    section.until = until;
    section.radius = radius;
    Random random(seed, 57);
    for (size_t i = 0; i < kAmplitudes.size(); i++) {
        section.phases[i] = random.uniform(0.0, 2.0 * kPi);
        section.drifts[i] = random.uniform(-kDrift, kDrift) * static_cast<double>(i + 2) / radius;
    }
    return section;
}

namespace {

// What the places say of one ring, in the frame of section_zero().
RingOutline outline_by(std::span<const SectionPlace> places, double along, double lead) {
    RingOutline ring{along};
    const auto add = [&](const SectionPlace& place, double share) {
        ring.share += share;
        for (size_t i = 0; i < ring.cosine.size(); i++) {
            ring.cosine[i] += share * static_cast<double>(place.shape->cosine[i]);
            ring.sine[i] += share * static_cast<double>(place.shape->sine[i]);
        }
    };
    const auto above =
        std::upper_bound(places.begin(), places.end(), along,
                         [](double at, const SectionPlace& place) { return at < place.along; });
    const auto seen = [](const SectionPlace& place) { return place.shape != nullptr; };
    const auto high = std::find_if(above, places.end(), seen);
    auto low = above;
    while (low != places.begin() && !seen(low[-1]))
        --low;
    const bool from_low = low != places.begin(), from_high = high != places.end();
    if (from_low) --low;
    if (from_low && from_high && high - low == 1) {
        const double t = (along - low->along) / std::max(high->along - low->along, 1e-30);
        add(*low, 1.0 - t);
        add(*high, t);
        return ring;
    }
    // Between them something was not seen.
    const double by_low = from_low ? glm::smoothstep(0.0, 1.0, 1.0 - (along - low->along) / lead) : 0.0;
    const double by_high = from_high ? glm::smoothstep(0.0, 1.0, 1.0 - (high->along - along) / lead) : 0.0;
    const double sum = std::max(by_low + by_high, 1.0);
    if (by_low > 0.0) add(*low, by_low / sum);
    if (by_high > 0.0) add(*high, by_high / sum);
    return ring;
}

}  // namespace

double section_lead(double radius) {
    return kLeadRadii * radius;
}

double outline_relief(std::span<const SectionPlace> places, double along, double lead) {
    const RingOutline ring = outline_by(places, along, lead);
    double sum = 0.0;
    for (size_t i = 0; i < ring.cosine.size(); i++)
        sum += 2.0 * portable::hypot(ring.cosine[i], ring.sine[i]);
    return sum;
}

double missed_outline(std::span<const SectionPlace> places, double from, double to, double lead) {
    const auto after = [](double at, const SectionPlace& place) { return at < place.along; };
    auto place = std::upper_bound(places.begin(), places.end(), from, after);
    const auto end = std::upper_bound(place, places.end(), to, after);
    if (place == end) return 0.0;
    const RingOutline low = outline_by(places, from, lead), high = outline_by(places, to, lead);
    double most = 0.0;
    for (; place != end; ++place) {
        const RingOutline own = outline_by(places, place->along, lead);
        const double t = (place->along - from) / std::max(to - from, 1e-30);
        double sum = 0.0;
        for (size_t i = 0; i < own.cosine.size(); i++)
            sum += portable::hypot(own.cosine[i] - glm::mix(low.cosine[i], high.cosine[i], t),
                                   own.sine[i] - glm::mix(low.sine[i], high.sine[i], t));
        most = std::max(most, sum);
    }
    return most;
}

void measure_section(UnevenSection& section, std::span<const SectionPlace> places, const Ring* rings,
                     size_t count, bool on_foot) {
    if (std::none_of(places.begin(), places.end(), [](const SectionPlace& p) { return p.shape != nullptr; }))
        return;
    section.rings.reserve(count);
    const double lead = section_lead(section.radius);
    for (size_t i = 0; i < count; i++) {
        const Ring& ring = rings[i];
        // A foot goes on down as it stands on the ground.
        RingOutline outline = outline_by(places, std::max(ring.along, 0.0), lead);
        outline.along = ring.along;
        double whole =
            section_steadiness(ring.normal) * glm::smoothstep(0.0, lead, section.until - ring.along);
        if (!on_foot) whole *= glm::smoothstep(0.0, lead, ring.along - section.from);
        const DVec3 zero = section_zero(ring.normal);
        const double turned = portable::atan2(glm::dot(zero, ring.y()), glm::dot(zero, ring.x));
        outline.share *= whole;
        for (size_t k = 0; k < outline.cosine.size(); k++) {
            const double by = static_cast<double>(k + 2) * turned;
            const double c = whole * outline.cosine[k], s = whole * outline.sine[k];
            outline.cosine[k] = c * portable::cos(by) - s * portable::sin(by);
            outline.sine[k] = s * portable::cos(by) + c * portable::sin(by);
        }
        section.rings.push_back(outline);
    }
}

}  // namespace treerec
