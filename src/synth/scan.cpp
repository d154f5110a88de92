#include "synth/scan.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/bounds.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "synth/scan_view.h"
#include "synth/surfaces.h"

namespace treerec {

namespace {

constexpr size_t kSurfacesPerCheck = 256;

Color8 shade(const DVec3& colour, double light) {
    Color8 result;
    for (int i = 0; i < 3; i++)
        result[i] = static_cast<uint8_t>(std::clamp(colour[i] * light, 6.0, 245.0));
    return result;
}

Color8 colour_of(ScanOrigin origin, Random& random) {
    const double light = 1.0 + 0.16 * random.normal();
    switch (origin) {
        case kFromLeaf:
            return shade(DVec3(86.0 + 20.0 * random.uniform(), 128.0, 52.0), light);
        case kFromWood:
            return shade(DVec3(124.0, 106.0, 88.0), light);
        case kMixedBeam:
        case kStray:
            break;
    }
    return shade(DVec3(140.0, 140.0, 138.0), light);
}

void require_share(double value, double largest, const char* what) {
    if (!(value >= 0.0 && value <= largest))
        throw Error(std::string(what) + " must lie between 0 and " + (largest < 1.0 ? "0.95." : "1."));
}

}  // namespace

VirtualScanOptions scan_options_for(Habit habit) {
    VirtualScanOptions options;
    if (habit == Habit::kPalm) options.fronds = 26;
    if (habit == Habit::kButtressed) options.buttresses = 5;
    return options;
}

VirtualScan scan_tree(const Tree& tree, const VirtualScanOptions& options, Progress* progress) {
    require_share(options.occlusion, 0.95, "The occlusion");
    require_share(options.leaves, 1.0, "The leaves");
    require_share(options.mixed, 1.0, "The share of mixed beams");
    require_share(options.stray, 1.0, "The share of stray points");
    if (!(options.noise >= 0.0 && options.noise <= 1.0)) throw Error("The noise must lie between 0 and 1 m.");
    if (!(options.beam_exit >= 0.0 && options.beam_exit <= 0.1 && options.beam_divergence >= 0.0 &&
          options.beam_divergence <= 0.01))
        throw Error("A beam must be at most 10 cm wide and grow by at most 1 cm per metre.");
    if (options.fronds < 0 || options.fronds > 200 || options.buttresses < 0 || options.buttresses > 20)
        throw Error("A tree can have up to 200 fronds and 20 buttresses.");
    if (options.points < 1 || options.points > 20'000'000)
        throw Error("A virtual scan can have 1 to 20 million points.");
    if (options.stations < 1 || options.stations > 64) throw Error("A virtual scan needs 1 to 64 stations.");
    std::vector<Surface> surfaces = wood_surfaces(tree);
    if (surfaces.empty()) throw Error("The tree has no wood to scan.");
    add_leaves(tree, options.leaves, options.seed, surfaces);
    add_fronds(tree, options.fronds, options.seed, surfaces);
    add_buttresses(tree, options.buttresses, options.seed, surfaces);
    Bounds bounds = tree.bounds();
    for (const Surface& surface : surfaces) {
        bounds.add(surface.from, surface.from_radius);
        if (surface.shape == Shape::kCone) bounds.add(surface.to, surface.to_radius);
    }

    Random random(options.seed, 20);
    const DVec3 base = tree.node(tree.root()).position;
    const double away = 0.5 * glm::length(DVec2(bounds.size().x, bounds.size().z));
    std::vector<DVec3> eyes;
    const double turn = random.uniform(0.0, 2.0 * kPi);
    for (int i = 0; i < options.stations; i++) {
        const double azimuth = turn + 2.0 * kPi * (i + random.uniform(-0.25, 0.25)) / options.stations;
        const double distance = std::max(random.uniform(8.0, 15.0), 1.3 * away);
        eyes.push_back(base +
                       DVec3(distance * portable::cos(azimuth), 1.5, distance * portable::sin(azimuth)));
    }

    const Beam beam{options.beam_exit, options.beam_divergence};
    const size_t stray = static_cast<size_t>(options.stray * static_cast<double>(options.points));
    const size_t wanted = std::max<size_t>(1, options.points - stray);
    const auto scan_all = [&](double step, std::vector<ScanReturn>& returns) {
        std::vector<std::vector<ScanReturn>> by_station(eyes.size());
        parallel_for(eyes.size(), 1, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                if (progress) progress->check();
                Random own(hash_seed(options.seed, i), 22);
                ScanView view(eyes[i], bounds.centre(), step, beam, bounds);
                for (size_t k = 0; k < surfaces.size(); k++) {
                    if (progress && k % kSurfacesPerCheck == 0) progress->check();
                    view.draw(surfaces[k], static_cast<int32_t>(k));
                }
                view.occlude(options.occlusion, own);
                view.collect(surfaces, options.noise, options.mixed, own, by_station[i]);
            }
        });
        for (const std::vector<ScanReturn>& station : by_station)
            returns.insert(returns.end(), station.begin(), station.end());
    };
    // Returns go with the square of the resolution: a coarse look tells how fine the beams must be.
    double step = glm::radians(0.12);
    std::vector<ScanReturn> returns;
    for (int attempt = 0; attempt < 4 && returns.size() < wanted; attempt++) {
        if (progress) progress->update(0.2 * attempt, "Scanning");
        returns.clear();
        scan_all(step, returns);
        const double found = std::max<double>(1.0, static_cast<double>(returns.size()));
        step *= std::sqrt(found / (1.06 * static_cast<double>(wanted)));
    }
    // A random part of what is too much: a shuffle of the first `wanted`, then back in the beams' order.
    std::vector<size_t> chosen(returns.size());
    for (size_t i = 0; i < chosen.size(); i++)
        chosen[i] = i;
    for (size_t i = 0; i < std::min(wanted, chosen.size()); i++)
        std::swap(chosen[i], chosen[i + random.below(static_cast<uint32_t>(chosen.size() - i))]);
    chosen.resize(std::min(wanted, chosen.size()));
    std::sort(chosen.begin(), chosen.end());

    VirtualScan scan;
    scan.cloud.frame = tree.frame();
    const auto add = [&](const DVec3& position, ScanOrigin origin, NodeId node) {
        scan.cloud.positions.emplace_back(position);
        scan.cloud.colors.push_back(colour_of(origin, random));
        scan.origin.push_back(origin);
        scan.node.push_back(node);
    };
    for (size_t i : chosen) {
        const Surface& surface = surfaces[static_cast<size_t>(returns[i].surface)];
        const ScanOrigin origin = surface.leaf ? kFromLeaf : kFromWood;
        add(returns[i].position, returns[i].mixed ? kMixedBeam : origin, surface.node);
    }
    const DVec3 margin = 0.1 * bounds.size();
    for (size_t i = 0; i < stray; i++) {
        DVec3 p;
        for (int axis = 0; axis < 3; axis++)
            p[axis] = random.uniform(bounds.min[axis] - margin[axis], bounds.max[axis] + margin[axis]);
        add(p, kStray, kNoNode);
    }
    if (progress) progress->update(1.0, "Scanning");
    return scan;
}

}  // namespace treerec
