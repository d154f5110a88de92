#include "foliage/leaf_placer.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr double kFullTreeHeight = 6.0;       // metres; smaller trees have shorter, thinner twigs
constexpr double kFullSprayHeight = 12.0;     // metres; smaller trees bear smaller sprays
constexpr double kClusterSteepness = 5.0;     // how fast a fully clustered twig gets bare below its tip
constexpr double kBunchSplay = 16.0;          // degrees between neighbours of a bunch
constexpr double kJitter = 0.0175;            // radians around the twig per degree of angle_variation
constexpr double kSunk = 0.9;                 // of the wood's radius: where a petiole leaves the axis
constexpr double kColorHue = 0.7;             // of a leaf's hue, where the scan has colours
constexpr uint64_t kFallKey = 0x66616c6cULL;  // "fall"
constexpr uint64_t kThinKey = 0x7468696eULL;  // "thin"

ScaledLeaf scaled(const LeafRules& rules, double height) {
    const double twig = std::min(1.0, std::sqrt(height / kFullTreeHeight));
    const double spray = std::min(1.0, std::sqrt(height / kFullSprayHeight));
    return {std::max(rules.internode / rules.crowding * spray, 1e-4 * height), rules.twig_length * twig,
            rules.maximum_radius * twig, rules.leaf_size * (rules.form == LeafForm::kSpray ? spray : 1.0)};
}

// A table of even steps, straight lines between them.
double lookup(const std::vector<float>& table, double share) {
    if (table.empty()) return 1.0;
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(table.size() - 1);
    const auto low = static_cast<size_t>(at);
    const size_t high = std::min(low + 1, table.size() - 1);
    return table[low] + (table[high] - table[low]) * (at - static_cast<double>(low));
}

double number_of(uint64_t seed, uint64_t key) {
    return static_cast<double>(hash_seed(seed, key) >> 11) * 0x1p-53;
}

// As Random::direction(), which asks for the sine and the cosine one by one.
DVec3 random_direction(Random& random) {
    const double z = random.uniform(-1.0, 1.0);
    const SineCosine turn = portable_sine_cosine(random.uniform(0.0, 2.0 * kPi));
    const double r = std::sqrt(1.0 - z * z);
    return {r * turn.cosine, r * turn.sine, z};
}

}  // namespace

LeafPlacer::LeafPlacer(const Tree& t, const LeafRules& r, uint64_t s)
    : tree(t),
      rules(r),
      list(list_branches(t)),
      crown(measure_crown(t)),
      wind(t, list, crown.height),
      size(scaled(r, crown.height)),
      leafy(crown),
      seed(s) {
    leafy.radii += DVec3(0.5 * size.leaf_size);
}

LeafPlacement LeafPlacer::leaf_at(const LeafSpot& spot) const {
    const auto& [at, radial, angle, tip, number, red, spare] = spot;
    const uint64_t branch_key = hash_seed(seed, static_cast<uint64_t>(tip));
    Random random(hash_seed(branch_key, number));
    const DVec3 up(0.0, 1.0, 0.0);
    const bool terminal = number == 0;
    const double lean_out =
        terminal ? 0.0 : glm::radians(angle + rules.angle_variation * random.uniform(-1.0, 1.0));
    const SineCosine out = portable_sine_cosine(lean_out);
    DVec3 y = at.direction * out.cosine + radial * out.sine;
    // Droop turns the leaf towards the ground, most where it lies level.
    const double droop = glm::radians(rules.droop + 0.5 * rules.angle_variation * random.uniform(-1.0, 1.0)) *
                         (terminal ? 0.4 : 1.0);
    y = normalized_or(y - up * portable::tan(std::clamp(droop, -1.2, 1.2)) * (1.0 - 0.6 * std::abs(y.y)),
                      at.direction);
    const DVec3 position = at.position + radial * (terminal ? 0.0 : kSunk * at.radius);
    const DVec3 outward = crown.outward(position);
    // The light comes from the sky and from out of the crown.
    const DVec3 light = up * 0.8 + outward * 0.5;
    const double bending = std::max(0.0, 2.0 * rules.phototropism - 1.0);
    y = normalized_or(y + light * (0.8 * bending), y);
    // By itself a leaf turns its upper face to the twig that it stands on.
    const double facing = std::min(1.0, 2.0 * rules.phototropism);
    DVec3 z = light * facing + (at.direction - y * glm::dot(at.direction, y)) * (1.0 - facing) +
              random_direction(random) * 0.35;
    const double lean = glm::radians(rules.angle_variation) * random.uniform(-1.0, 1.0);
    z = normalized_or(z - y * glm::dot(z, y), any_perpendicular(y));
    DVec3 x = glm::cross(y, z);
    const SineCosine turn = portable_sine_cosine(lean);
    z = glm::normalize(z * turn.cosine + x * turn.sine);
    x = glm::cross(y, z);

    LeafPlacement leaf;
    leaf.position = Vec3(position);
    leaf.x = Vec3(x);
    leaf.y = Vec3(y);
    leaf.z = Vec3(z);
    // What a leaf is seen with, its middle decides, in a crown that leaves are a part of: a palm's wood ends
    // in one point, out of which all fronds grow.
    const DVec3 middle = position + y * (0.5 * size.leaf_size);
    leaf.outward = Vec3(leafy.outward(middle));
    leaf.size = random_size(random);
    const double phase = branch_phase(tip) + 0.25 * random.uniform();
    leaf.phase = static_cast<float>(phase - std::floor(phase));
    Random branch_random(branch_key, 1);
    leaf.hue = static_cast<float>(0.55 * branch_random.uniform() + 0.45 * random.uniform());
    if (red >= 0.0) {
        const double follow = kColorHue * rules.follow_color;
        leaf.hue = static_cast<float>(follow * red + (1.0 - follow) * leaf.hue);
    }
    const double stout = size.maximum_radius > 0.0 ? at.radius / size.maximum_radius : 1.0;
    leaf.stiffness = static_cast<float>(std::clamp(stout, 0.0, 1.0));
    leaf.sway = static_cast<float>(crown.sway(at.position));
    leaf.wind = wind.codes(static_cast<size_t>(list.branch_of[static_cast<size_t>(tip)]), at.way,
                           position - at.position);
    leaf.occlusion = static_cast<float>(0.35 + 0.65 * leafy.openness(middle));
    leaf.terminal = terminal ? 1.0f : 0.0f;
    const double hold = number_of(branch_key ^ kFallKey, number);
    leaf.hold = static_cast<float>(terminal ? std::sqrt(hold) : hold);
    return leaf;
}

float LeafPlacer::size_of(const LeafSpot& spot) const {
    Random random(hash_seed(hash_seed(seed, static_cast<uint64_t>(spot.tip)), spot.number));
    // What leaf_at() asks for before; a leaf at a tip has no angle.
    for (int passed = spot.number == 0 ? 4 : 5; passed > 0; passed--)
        random.next();
    return random_size(random);
}

float LeafPlacer::random_size(Random& random) const {
    return static_cast<float>(size.leaf_size * (1.0 + rules.size_variation * random.uniform(-1.0, 1.0)));
}

LeafSpot LeafPlacer::tip_spot(const Branch& branch, const AxisPoint& end) const {
    return {end, end.direction, 0.0, list.nodes[branch.end - 1], 0};
}

double LeafPlacer::density_at(const Branch& branch, const AxisPoint& at) const {
    double density = lookup(rules.by_height, (at.position.y - crown.ground) / crown.height);
    if (!rules.by_radius.empty())
        density *= lookup(rules.by_radius, size.maximum_radius > 0.0 ? at.radius / size.maximum_radius : 1.0);
    if (!rules.by_order.empty())
        density *= rules.by_order[std::min(static_cast<size_t>(branch.order), rules.by_order.size() - 1)];
    return density;
}

// Where the first leaf stands: to the side of a twig that leans, as the turtle's $ has it, so that leaves of
// two ranks lie level.
DVec3 LeafPlacer::first_side(const DVec3& direction) const {
    return normalized_or(glm::cross(direction, DVec3(0.0, 1.0, 0.0)), any_perpendicular(direction));
}

void LeafPlacer::bear(const Branch& branch, double share, double crowding, std::vector<AxisPoint>& axis,
                      std::vector<LeafSpot>& spots) const {
    if (share <= 0.0) return;
    sample_axis(tree, list, branch, 2e-5 * crown.coordinate, axis);
    if (axis.size() < 2) return;
    const NodeId tip = list.nodes[branch.end - 1];
    const AxisPoint end = axis.back();
    spots.push_back(tip_spot(branch, end));
    spots.back().spare = !(density_at(branch, end) > 0.0);
    uint64_t number = 1;
    // The tip bears leaves however thick a scan made it.
    const double stoutest = std::max(size.maximum_radius, 1.5 * end.radius);
    const double buried = branch.attach == kNoNode ? 0.0 : tree.node(branch.attach).radius;
    const uint64_t branch_key = hash_seed(seed, static_cast<uint64_t>(tip));
    Random random(branch_key, 2);
    const int count = leaves_per_node(rules);
    const bool ranked =
        rules.arrangement == LeafArrangement::kAlternate || rules.arrangement == LeafArrangement::kOpposite;
    double azimuth = random.uniform(0.0, 2.0 * kPi);
    if (ranked) azimuth = 0.0;
    const double internode = size.internode * count / crowding;
    double along = end.along - size.internode / crowding * random.uniform(0.5, 1.0);
    const double lowest = std::max(end.along - size.twig_length, buried);
    size_t hint = axis.size() - 2;
    // A frame carried down from the tip; over a twig's length its twist is no matter.
    DVec3 side = ranked ? first_side(end.direction) : any_perpendicular(end.direction);
    while (along > lowest) {
        const AxisPoint at = axis_at(axis, along, hint);
        if (at.radius > stoutest) break;
        side = normalized_or(side - at.direction * glm::dot(side, at.direction),
                             any_perpendicular(at.direction));
        const DVec3 other = glm::cross(at.direction, side);
        const double turned = azimuth + kJitter * rules.angle_variation * random.uniform(-1.0, 1.0);
        const double down = size.twig_length > 0.0 ? (end.along - along) / size.twig_length : 0.0;
        const double angle = rules.angle * (1.0 - rules.closing * (1.0 - down));
        const double density = density_at(branch, at);
        double wanted = share;
        if (rules.clustering > 0.0) wanted *= portable::exp(-kClusterSteepness * rules.clustering * down);
        for (int k = 0; k < count; k++) {
            const uint64_t own = number++;
            const double place = number_of(branch_key ^ kThinKey, own);
            if (place >= wanted) continue;
            double around = turned, out = angle;
            if (rules.arrangement == LeafArrangement::kFascicled) {
                // A bunch spreads like a fan, wider than deep.
                const double aside = count > 1 ? k - 0.5 * (count - 1) : 0.0;
                around += glm::radians(kBunchSplay) * aside;
                out += (k % 2 ? 0.6 : -0.6) * kBunchSplay;
            } else {
                around += 2.0 * kPi * k / count;
            }
            const SineCosine turn = portable_sine_cosine(around);
            const DVec3 radial = side * turn.cosine + other * turn.sine;
            spots.push_back({at, radial, out, tip, own});
            spots.back().spare = place >= wanted * density;
        }
        switch (rules.arrangement) {
            case LeafArrangement::kAlternate:
                azimuth += kPi;
                break;
            case LeafArrangement::kOpposite:
                break;
            case LeafArrangement::kDecussate:
                azimuth += 0.5 * kPi;
                break;
            case LeafArrangement::kWhorled:
                azimuth += kPi / count;
                break;
            case LeafArrangement::kSpiral:
            case LeafArrangement::kFascicled:
                azimuth += glm::radians(rules.divergence);
                break;
        }
        along -= internode * random.uniform(0.8, 1.2);
    }
}

}  // namespace treerec
