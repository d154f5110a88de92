#include "growth/recipe.h"

#include "edit/commands/address.h"

#include "edit/commands/command_text.h"

namespace treerec {

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
