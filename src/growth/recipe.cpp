#include "growth/recipe.h"

#include <cmath>

#include "edit/address.h"
#include "edit/command_text.h"

namespace treerec {

namespace {

constexpr double kLeastEdge = 0.002, kLargestEdge = 1.0;  // metres

void take_edges(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.longest = arguments.number("longest");
    recipe.shortest = arguments.has("shortest") ? arguments.number("shortest") : recipe.longest * 15.0 / 35.0;
    if (recipe.shortest > 0.5 * recipe.longest)
        throw Error("The shortest edge must be at most half of the longest: with longest=" +
                    number_text(recipe.longest) + " give shortest=" + number_text(0.5 * recipe.longest) +
                    " or less.");
}

void take_steps(GrowthRecipe& recipe, const EditArguments& arguments) {
    recipe.steps = static_cast<int>(arguments.whole("count"));
}

void take_burl(GrowthRecipe& recipe, const EditArguments& arguments) {
    GrowthFeature feature;
    feature.kind = GrowthFeature::Kind::kBurl;
    feature.node = arguments.node("node");
    feature.along = arguments.number("along");
    feature.around = arguments.number("around");
    feature.radius = arguments.number("radius");
    feature.inner = arguments.has("inner") ? arguments.number("inner") : 0.5 * feature.radius;
    feature.growth = arguments.number("growth");
    feature.from = arguments.number("from");
    if (feature.inner > feature.radius)
        throw Error("A burl's inner=" + number_text(feature.inner) +
                    " is larger than its radius=" + number_text(feature.radius) + ": make it smaller.");
    recipe.features.push_back(feature);
}

Parameter where_node() {
    Parameter parameter = node_parameter("node", "on whose branch it is");
    parameter.standard = "root";
    parameter.required = false;
    return parameter;
}

}  // namespace

const std::vector<GrowthCommand>& growth_commands() {
    static const std::vector<GrowthCommand> commands{
        {"edges",
         "How fine the surface is.",
         {length_parameter("longest", 0.035, kLeastEdge, kLargestEdge, "edges are split above it"),
          length_parameter("shortest", NAN, kLeastEdge / 4.0, kLargestEdge,
                           "edges that become shorter are merged; at most half of longest")
              .optional()},
         take_edges},
        {"steps",
         "How many steps it grows.",
         {whole_parameter("count", 0, 0, 5000, "0: as many as the tree needs")},
         take_steps},
        {"burl",
         "A lump where cambium grows faster.",
         {where_node(),
          length_parameter("along", 1.3, -1000.0, 1000.0,
                           "from the node along its branch; of the trunk from its foot"),
          number_parameter("around", 0.0, -3600.0, 3600.0, "degrees about the branch").slider(0.0, 360.0),
          length_parameter("radius", 0.3, 0.001, 10.0, "around its middle in which cambium grows faster")
              .slider(0.02, 1.0),
          length_parameter("inner", NAN, 0.0, 10.0,
                           "around its middle in which all grows alike; half of radius")
              .optional(),
          number_parameter("growth", 0.5, 0.0, 20.0, "how much faster, over the usual").slider(0.0, 2.0),
          number_parameter("from", 0.0, 0.0, 1.0,
                           "share of the age of the wood there after which it begins")},
         take_burl},
    };
    return commands;
}

GrowthRecipe read_growth_recipe(const Tree& tree, std::string_view text) {
    GrowthRecipe recipe;
    size_t number = 0;
    for (const std::string_view line : split(text, '\n')) {
        number++;
        const auto where = [&](const Error& error) {
            return "Line " + std::to_string(number) + " of the recipe: " + error.what();
        };
        try {
            const std::optional<CommandLine> parsed = parse_command_line(line);
            if (!parsed) continue;
            const GrowthCommand* known = nullptr;
            std::string names;
            for (const GrowthCommand& command : growth_commands()) {
                if (command.name == parsed->name) known = &command;
                names += (names.empty() ? "" : ", ") + command.name;
            }
            if (!known)
                throw CommandError(
                    "There is no " + quote_word(parsed->name) + "; a recipe has " + names + ".",
                    parsed->column);
            const EditArguments arguments(tree, *parsed, known->parameters, {});
            known->take(recipe, arguments);
            recipe.text += arguments.line() + "\n";
        } catch (const Misfit& misfit) {
            throw Misfit(where(misfit));
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            throw Error(where(error));
        }
    }
    return recipe;
}

}  // namespace treerec
