#include "sketch/species.h"

#include "edit/scion.h"
#include "edit/twig_library.h"
#include "error.h"
#include "lsystem/lstring.h"

namespace treerec {

namespace {

SketchSpecies make_species(const char* name, const char* title, double height, TwigArrangement arrangement) {
    SketchSpecies species{name, title, height, arrangement, {}};
    for (const char* size : {"_short", "_medium", "_long"}) {
        SpeciesTwig twig;
        twig.name = species.name + size;
        twig.scion = read_lstring(find_library_twig(twig.name).string);
        twig.length = scion_length(twig.scion);
        twig.radius = twig.scion.node(twig.scion.root()).radius;
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
