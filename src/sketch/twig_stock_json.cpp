// Own twigs as JSON.
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "error.h"
#include "sketch/twig_stock.h"

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLargest = size_t{16} << 20U;  // bytes
constexpr size_t kMostAngles = 1000;
constexpr std::array<std::pair<TwigArrangement, const char*>, 3> kArrangements = {
    {{TwigArrangement::kAlternate, "alternate"},
     {TwigArrangement::kOpposite, "opposite"},
     {TwigArrangement::kClustered, "clustered"}}};

// Reads one stock; who: the subject of what it throws.
class StockReader {
  public:
    explicit StockReader(const std::string& who) : who_(who) {}

    TwigStock read(std::string_view text) const {
        if (text.size() > kLargest) fail("are larger than 16 MiB, which none of a sketch are");
        Json json;
        try {
            json = Json::parse(text.begin(), text.end());
        } catch (const Json::exception&) {
            fail("cannot be read as JSON");
        }
        const Json* twigs = json.is_object() ? member(json, "twigs") : nullptr;
        if (!twigs || !twigs->is_array()) fail("have no list of 'twigs'");
        std::vector<std::string> strings;
        for (const Json& one : *twigs) {
            if (!one.is_string()) fail("have one that is no text");
            strings.push_back(one.get<std::string>());
        }
        std::string title;
        if (const Json* given = member(json, "title")) {
            if (!given->is_string()) fail("have a 'title' that is no text");
            title = given->get<std::string>();
        }
        TwigStock stock = stock_of_twigs(strings, title);
        stock.height = number(json, "height", 0.0, 0.0, 200.0);
        stock.internode = number(json, "internode", 0.0, 0.0, 200.0);
        if (const Json* given = member(json, "arrangement")) {
            bool known = false;
            for (const auto& [arrangement, name] : kArrangements)
                if (*given == name) {
                    stock.arrangement = arrangement;
                    known = true;
                }
            if (!known) fail("have an 'arrangement' that is none of alternate, opposite and clustered");
        }
        if (const Json* angles = member(json, "angles")) {
            if (!angles->is_array() || angles->size() > kMostAngles) fail("have 'angles' that are no list");
            for (const Json& angle : *angles) {
                const double value = angle.is_number() ? angle.get<double>() : -1.0;
                if (!(value > 0.0 && value < 180.0) || (!stock.angles.empty() && value < stock.angles.back()))
                    fail("have 'angles' that are not from 0 to 180 degrees, in ascending order");
                stock.angles.push_back(value);
            }
            if (stock.angles.size() == 1) stock.angles.push_back(stock.angles[0]);
        }
        if (const Json* taper = member(json, "taper")) {
            if (!taper->is_object()) fail("have a 'taper' that is no {...}");
            stock.taper = taper_of(*taper);
        }
        return stock;
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw Error(who_ + " " + what + "."); }

    WoodTaper taper_of(const Json& json) const {
        WoodTaper taper;
        taper.height = number(json, "height", -1.0, 0.001, 200.0);
        taper.stem_base =
            number(json, json.contains("base") ? "base" : "foot", -1.0, 1e-6, 0.2 * taper.height);
        taper.branches.known = true;
        taper.branches.intercept = number(json, "intercept", -1e9, -100.0, 100.0);
        taper.branches.slope = number(json, "slope", -1.0, 0.0, 10.0);
        taper.branches.least = number(json, "least", -1.0, 0.0, 10.0);
        taper.trunk = profile(json, "trunk");
        taper.branches.profile = profile(json, "profile");
        return taper;
    }

    std::array<double, 11> profile(const Json& json, const char* name) const {
        std::array<double, 11> shares{};
        const Json* list = member(json, name);
        if (!list || !list->is_array() || list->size() != shares.size())
            fail(std::string("have a taper whose '") + name + "' is not eleven numbers");
        for (size_t i = 0; i < shares.size(); i++) {
            shares[i] = (*list)[i].is_number() ? (*list)[i].get<double>() : -1.0;
            if (!(shares[i] >= 0.0 && shares[i] <= 1.0) || (i > 0 && shares[i] > shares[i - 1]))
                fail(std::string("have a taper whose '") + name + "' does not fall from 1 to 0");
        }
        return shares;
    }

    double number(const Json& json, const char* name, double otherwise, double least, double most) const {
        const Json* value = member(json, name);
        if (value && !value->is_number()) fail(std::string("have a '") + name + "' that is no number");
        const double given = value ? value->get<double>() : otherwise;
        if (!(given >= least && given <= most))
            fail(std::string("have a '") + name + "' that is out of range, or none");
        return given;
    }

    static const Json* member(const Json& json, const char* name) {
        const auto found = json.find(name);
        return found != json.end() ? &*found : nullptr;
    }

    const std::string& who_;
};

}  // namespace

std::string twig_stock_json(const TwigStock& stock) {
    Json json;
    json["title"] = stock.title;
    json["height"] = stock.height;
    for (const auto& [arrangement, name] : kArrangements)
        if (arrangement == stock.arrangement) json["arrangement"] = name;
    if (!stock.angles.empty()) json["angles"] = stock.angles;
    json["internode"] = stock.internode;
    if (stock.taper) {
        const RadiusLaw& law = stock.taper->branches;
        json["taper"] = {{"height", stock.taper->height},
                         {"base", stock.taper->stem_base},
                         {"trunk", stock.taper->trunk},
                         {"intercept", law.intercept},
                         {"slope", law.slope},
                         {"profile", law.profile},
                         {"least", law.least}};
    }
    json["twigs"] = Json::array();
    for (const TwigStock::Twig& twig : stock.twigs)
        json["twigs"].push_back(twig.string);
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

TwigStock parse_twig_stock(std::string_view json, const std::string& who) {
    return StockReader(who).read(json);
}

}  // namespace treerec
