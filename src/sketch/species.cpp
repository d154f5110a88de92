#include "sketch/species.h"

#include <algorithm>
#include <cmath>

#include "edit/graft/scion.h"
#include "edit/graft/twig_library.h"
#include "error.h"
#include "geometry/portable_math.h"
#include "lsystem/lstring.h"
#include "sketch/sketch_axes.h"

namespace treerec {

namespace {

SketchSpecies make_species(const char* name, const char* title, double height, TwigArrangement arrangement) {
    SketchSpecies species;
    species.name = name;
    species.title = title;
    species.height = height;
    species.arrangement = arrangement;
    species.leaves = leaf_preset(name);
    for (const char* size : {"_short", "_medium", "_long"}) {
        SpeciesTwig twig;
        twig.name = species.name + size;
        twig.scion = read_lstring(find_library_twig(twig.name).string);
        twig.length = scion_length(twig.scion);
        twig.radius = twig.scion.node(twig.scion.root()).radius;
        twig.size = static_cast<int>(species.twigs.size());
        species.twigs.push_back(std::move(twig));
    }
    return species;
}

// By name.
const std::vector<SketchSpecies>& all_species() {
    static const std::vector<SketchSpecies> all = [] {
        std::vector<SketchSpecies> made;
        made.push_back(make_species("ginkgo", "Ginkgo", 14.0, TwigArrangement::kAlternate));
        made.push_back(make_species("magnolia", "Magnolia", 10.0, TwigArrangement::kClustered));
        made.push_back(make_species("maple", "Maple", 12.0, TwigArrangement::kOpposite));
        made.push_back(make_species("poplar", "Poplar", 18.0, TwigArrangement::kAlternate));
        return made;
    }();
    return all;
}

}  // namespace

WoodTaper WoodTaper::at_height(double metres) const {
    const double times = metres / height;
    WoodTaper scaled = *this;
    scaled.height = metres;
    scaled.stem_base *= times;
    // r(l) becomes times r(l / times).
    scaled.branches.intercept += (1.0 - branches.slope) * portable::log(times);
    scaled.branches.least *= times;
    return scaled;
}

std::vector<double> WoodTaper::trunk_radii(const std::vector<DVec3>& points, double base,
                                           double least) const {
    const double length = length_of(points);
    std::vector<double> radii;
    double along = 0.0, before = base;
    for (size_t i = 0; i < points.size(); i++) {
        if (i > 0) along += glm::length(points[i] - points[i - 1]);
        const double own = base * profile_at(trunk, length > 0.0 ? along / length : 1.0);
        radii.push_back(before = std::max(std::min(own, before), least));
    }
    return radii;
}

double SketchSpecies::angle_at(double share) const {
    const double at = share * static_cast<double>(angles.size() - 1);
    const size_t i = std::min(static_cast<size_t>(at), angles.size() - 2);
    return angles[i] + (angles[i + 1] - angles[i]) * (at - static_cast<double>(i));
}

std::vector<std::string> sketch_species_names() {
    std::vector<std::string> names;
    for (const SketchSpecies& species : all_species())
        names.push_back(species.name);
    return names;
}

const SketchSpecies& sketch_species(const std::string& name) {
    std::string known;
    for (const SketchSpecies& species : all_species()) {
        if (species.name == name) return species;
        known += (known.empty() ? "" : ", ") + species.name;
    }
    throw Error("There are no twigs of " + quote_word(name) + " for a sketch; use one of: " + known + ".");
}

}  // namespace treerec
