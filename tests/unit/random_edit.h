// Random commands for tests, from what the commands say about themselves: a new command takes part by itself.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "edit/commands/commands.h"
#include "geometry/random.h"
#include "tree/tree.h"

namespace treerec::test {

inline NodeId random_node(const Tree& tree, const std::vector<NodeId>& ids, Random& random) {
    // Often a tip or nearly so, or edits would soon leave nothing of the tree.
    NodeId id = ids[random.below(static_cast<uint32_t>(ids.size()))];
    for (uint32_t up = random.below(30); up > 0 && tree.node(id).first_child != kNoNode; up--)
        id = random.below(2) ? tree.node(id).first_child : tree.node(id).last_child;
    return id;
}

inline std::string random_nodes(const Tree& tree, const std::vector<NodeId>& ids, Random& random) {
    const std::string id = std::to_string(random_node(tree, ids, random));
    switch (random.below(8)) {
        case 0:
            return "all";
        case 1:
            return "below:" + id;
        case 2:
            return "branch:" + id;
        case 3:
            return "order:" + std::to_string(1 + random.below(5)) + "..&!below:" + id;
        case 4:
            return "radius:.." + number_text(tree.node(ids[0]).radius * 0.1) + "," + id;
        case 5:
            return "leaves&!trunk";
        default:
            return id + "," + std::to_string(random_node(tree, ids, random));
    }
}

inline std::string random_value(const Parameter& parameter, const Tree& tree, const std::vector<NodeId>& ids,
                                Random& random) {
    const Bounds bounds = tree.bounds();
    // From 10 to 10,000, as often below 316 as above.
    const auto between = [&] {
        const double from = parameter.from, to = parameter.to, share = random.uniform();
        return from > 0.0 && to > 20.0 * from ? from * std::pow(to / from, share)
                                              : from + (to - from) * share;
    };
    switch (parameter.type) {
        case ParameterType::kNumber:
        case ParameterType::kLength:
            return number_text(between());
        case ParameterType::kWhole:
            return std::to_string(static_cast<int64_t>(between()));
        case ParameterType::kSwitch:
            return random.below(2) ? "yes" : "no";
        case ParameterType::kWord:
        case ParameterType::kText:
            return parameter.words[random.below(static_cast<uint32_t>(parameter.words.size()))];
        case ParameterType::kNode:
            return std::to_string(random_node(tree, ids, random));
        case ParameterType::kNodes:
            return random_nodes(tree, ids, random);
        case ParameterType::kPoint:
            return vector_text(bounds.min +
                               bounds.size() * DVec3(random.uniform(), random.uniform(), random.uniform()));
        case ParameterType::kOffset:
            return vector_text(random.direction() * (0.05 * bounds.diagonal() * random.uniform()));
        case ParameterType::kDirection:
            return vector_text(random.direction());
    }
    return "";
}

inline std::string random_command(const EditCommand& command, const Tree& tree, Random& random) {
    const std::vector<NodeId> ids = tree.depth_first();
    std::string line = command.name;
    for (const Parameter& parameter : command.parameters)
        if (parameter.required || random.below(2))
            append_word(line, parameter.name, random_value(parameter, tree, ids, random));
    return line;
}

}  // namespace treerec::test
