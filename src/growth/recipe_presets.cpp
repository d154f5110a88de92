#include "growth/presets.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "edit/commands/command_text.h"
#include "growth/recipe.h"
#include "tree/measure.h"

namespace treerec {

namespace {

constexpr double kFine = 0.2;        // of the trunk's radius: edges that show a preset's mouths and lips
constexpr double kFinest = 0.01;     // metres
constexpr double kMostWork = 7e6;    // vertices times steps: about half a minute of one core
constexpr double kVertexArea = 0.3;  // squares of the longest edge, of surface to each vertex
constexpr double kCoarser = 1.02;    // from one try to the next
constexpr double kShortest = 15.0 / 35.0;  // of the longest edge, where a recipe names none

// Vertices that a surface has in the end, around all wood that is thick enough for such edges, times the
// steps in which its tips come to where that ends.
double work(const Tree& tree, const std::vector<NodeId>& nodes, double longest) {
    double area = 0.0, highest = 0.0;
    std::vector<double> along(static_cast<size_t>(tree.id_end()), 0.0);
    for (const NodeId id : nodes) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const double length = glm::distance(node.position, tree.node(node.parent).position);
        along[static_cast<size_t>(id)] = along[static_cast<size_t>(node.parent)] + length;
        if (node.radius < kShortest * longest) continue;
        area += 2.0 * kPi * node.radius * length;
        highest = std::max(highest, along[static_cast<size_t>(id)]);
    }
    return area / (kVertexArea * longest * longest) * (highest / longest);
}

}  // namespace

double trunk_radius(const Tree& tree) {
    const double dbh = measure(tree).dbh;
    return dbh > 0.0 ? 0.5 * dbh : tree.node(tree.root()).radius;
}

double preset_edges(const Tree& tree) {
    const std::vector<NodeId> nodes = tree.depth_first();
    double longest = std::max(kFine * trunk_radius(tree), kFinest);
    while (work(tree, nodes, longest) > kMostWork)
        longest *= kCoarser;
    return std::round(1000.0 * longest) / 1000.0;
}

std::string preset_recipe(const GrowthPreset& preset, const Tree& tree) {
    return "edges longest=" + number_text(preset_edges(tree)) + "\n" +
           scale_recipe(preset.recipe, trunk_radius(tree) / kPresetRadius);
}

const GrowthPreset& find_growth_preset(std::string_view name) {
    std::string names;
    for (const GrowthPreset& preset : growth_presets()) {
        if (preset.name == name) return preset;
        names += (names.empty() ? "" : ", ") + std::string(preset.name);
    }
    throw Error("There is no recipe " + quote_word(name) + "; there are " + names + ".");
}

std::string scale_recipe(std::string_view text, double factor) {
    std::string scaled;
    for (const std::string_view line : split(text, '\n')) {
        const std::optional<CommandLine> parsed = parse_command_line(line);
        if (!parsed) continue;
        std::string one = parsed->name;
        for (const CommandWord& word : parsed->words) {
            std::string value = word.value;
            for (const GrowthCommand& command : growth_commands())
                for (const Parameter& parameter : command.parameters) {
                    if (command.name != parsed->name || parameter.name != word.key) continue;
                    const std::optional<double> number = read_number(word.value);
                    if (!number) continue;
                    if (parameter.type == ParameterType::kLength) value = number_text(*number * factor);
                    // Radians a metre: as many to a trunk's thickness.
                    if (parameter.name == "twist") value = number_text(*number / factor);
                }
            append_word(one, word.key, value);
        }
        scaled += one + "\n";
    }
    return scaled;
}

}  // namespace treerec
