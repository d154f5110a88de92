// What a user wants grown, as text: a command a line (edit/command_text.h), so that it is edited, undone and
// replayed as text is.
//
//     edges longest=0.035 shortest=0.015
//     burl along=1.3 around=90 radius=0.3 inner=0.16 growth=0.5
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "edit/arguments.h"
#include "tree/tree.h"

namespace treerec {

struct GrowthFeature {
    enum class Kind : uint8_t { kBurl };
    Kind kind = Kind::kBurl;
    NodeId node = kNoNode;  // on whose branch it is
    double along = 0.0;     // metres from that node along its branch; of the trunk: from the ground
    double around = 0.0;    // degrees about the axis, from +X by way of -Z, seen from above
    double radius = 0.3;    // R, metres
    double inner = 0.16;    // R', metres
    double growth = 0.5;    // k: how much faster than S_c
    double from = 0.0;      // share of its wood's age after which it begins
};

struct GrowthRecipe {
    double longest = 0.035;   // T_s, metres
    double shortest = 0.015;  // T_m, metres
    int steps = 0;            // 0: as many as the tree needs
    std::vector<GrowthFeature> features;
    std::string text;  // its lines as found on this tree
};

// How a written recipe begins, before the number of its version.
inline constexpr char kGrowthRecipeMark[] = "# treerec growth recipe ";

struct GrowthCommand {
    std::string name;
    std::string summary;  // one sentence
    std::vector<Parameter> parameters;
    void (*take)(GrowthRecipe& recipe, const EditArguments& arguments);
};
const std::vector<GrowthCommand>& growth_commands();

// Throws CommandError with the line's number for what makes no command, Misfit for a node that is not there.
GrowthRecipe read_growth_recipe(const Tree& tree, std::string_view text);

}  // namespace treerec
