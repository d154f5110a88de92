#include "sketch/twig_stock.h"

#include <algorithm>
#include <cmath>

#include "edit/graft/scion.h"
#include "error.h"
#include "geometry/portable_math.h"
#include "lsystem/lstring.h"

namespace treerec {

namespace {

constexpr size_t kMostTwigs = 200;
constexpr size_t kMostNodes = 2000;                  // of one
constexpr double kShortest = 0.01, kLongest = 20.0;  // metres
constexpr double kStoutest = 0.25;                   // radius over length
constexpr int kSizes = 3;                            // short, medium, long
constexpr double kOneSize = 1.3;  // the longest over the shortest, where all are of one size

std::string number(double value) {
    std::string text = std::to_string(value);
    while (text.back() == '0')
        text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text;
}

}  // namespace

TwigStock stock_of_twigs(const std::vector<std::string>& strings, const std::string& title) {
    if (strings.empty()) throw Error("The library has no twigs: keep some branches in it first.");
    if (strings.size() > kMostTwigs)
        throw Error("The library has " + std::to_string(strings.size()) + " twigs; a sketch takes at most " +
                    std::to_string(kMostTwigs) + ".");
    TwigStock stock;
    stock.title = title;
    for (size_t i = 0; i < strings.size(); i++) {
        const std::string which = "Twig " + std::to_string(i + 1) + " of the library ";
        TwigStock::Twig twig{strings[i], {}};
        LStringOptions options;
        options.most_nodes = kMostNodes;
        try {
            twig.scion = read_lstring(strings[i], options);
            require_scion(twig.scion);
        } catch (const Error& error) {
            throw Error(which + "is no branch for a sketch. " + error.what());
        }
        const double length = scion_length(twig.scion);
        if (!(length >= kShortest && length <= kLongest))
            throw Error(which + "is " + number(length) + " m long; a sketch takes twigs from 0.01 to 20 m.");
        if (twig.scion.node(twig.scion.root()).radius > kStoutest * length)
            throw Error(which + "is too thick for its length: its radius is more than a quarter of it.");
        stock.twigs.push_back(std::move(twig));
    }
    std::stable_sort(stock.twigs.begin(), stock.twigs.end(),
                     [](const TwigStock::Twig& a, const TwigStock::Twig& b) {
                         return scion_length(a.scion) < scion_length(b.scion);
                     });
    return stock;
}

SketchSpecies species_of(const TwigStock& stock, const std::string& preset) {
    SketchSpecies species;
    species.name = preset;
    species.title = stock.title;
    species.leaves = leaf_preset(preset);
    species.own = true;
    species.arrangement = stock.arrangement;
    species.internode = stock.internode;
    species.taper = stock.taper;
    if (stock.angles.size() > 1) species.angles = stock.angles;
    for (size_t i = 0; i < stock.twigs.size(); i++) {
        SpeciesTwig twig;
        twig.name = std::to_string(i + 1);
        twig.scion = stock.twigs[i].scion;
        twig.length = scion_length(twig.scion);
        twig.radius = twig.scion.node(twig.scion.root()).radius;
        species.twigs.push_back(std::move(twig));
    }
    // Equal steps of the logarithm: a twig is scaled by a factor.
    const double shortest = species.twigs.front().length, longest = species.twigs.back().length;
    for (SpeciesTwig& twig : species.twigs)
        if (longest > kOneSize * shortest)
            twig.size = std::min(kSizes - 1, static_cast<int>(kSizes * portable::log(twig.length / shortest) /
                                                              portable::log(longest / shortest)));
    if (stock.height > 0.0) {
        species.height = stock.height;
    } else {
        for (const std::string& name : sketch_species_names())
            if (name == preset) species.height = sketch_species(name).height;
    }
    return species;
}

}  // namespace treerec
