#include "mesh/uneven_section.h"

#include <algorithm>

#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {

namespace {

// Over the radius. Sections of scanned stems without buttresses vary by 7 % and more from their narrowest to
// their widest; these do by about 6.
constexpr std::array<double, 3> kAmplitudes = {0.018, 0.009, 0.005};
constexpr double kDrift = 0.12;     // radians per radius along, of the second harmonic, at most
constexpr double kLeadRadii = 2.5;  // over which it begins and ends

}  // namespace

double UnevenSection::at(double along, double angle, bool derivative) const {
    const double lead = kLeadRadii * radius;
    if (along <= from || along >= until) return 0.0;
    const double share = std::min({1.0, (along - from) / lead, (until - along) / lead});
    const double whole = share * share * (3.0 - 2.0 * share);
    double sum = 0.0;
    for (size_t i = 0; i < kAmplitudes.size(); i++) {
        const double order = static_cast<double>(i + 2);
        const double phase = order * angle + phases[i] + drifts[i] * along;
        sum += kAmplitudes[i] * (derivative ? -order * portable::sin(phase) : portable::cos(phase));
    }
    return whole * sum;
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

}  // namespace treerec
