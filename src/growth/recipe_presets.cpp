#include "growth/presets.h"

#include "edit/command_text.h"
#include "growth/recipe.h"
#include "tree/measure.h"

namespace treerec {

double trunk_radius(const Tree& tree) {
    const double dbh = measure(tree).dbh;
    return dbh > 0.0 ? 0.5 * dbh : tree.node(tree.root()).radius;
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
