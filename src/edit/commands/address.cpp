#include "edit/commands/address.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "edit/commands/command_text.h"
#include "geometry/portable_math.h"
#include "geometry/segment.h"

namespace treerec {

namespace {

constexpr double kSamePlace = 0.001;      // metres: a node that far from where it was has not moved
constexpr double kHeightShare = 0.01;     // of the tree's height: how far wood may have moved
constexpr double kDiameters = 1.0;        // and over its own diameter
constexpr double kLeastCosine = 0.5;      // of the angle between the directions
constexpr double kMostRadiusRatio = 3.0;  // between the radii
constexpr double kFinestPlace = 1e-4;     // metres: the last decimal of a place

struct Address {
    std::optional<NodeId> id;
    std::optional<DVec3> place;  // tree space, like the rest
    DVec3 direction{0.0};        // unit, or zero: none
    double radius = 0.0;         // 0: none
};

// The way the wood runs that ends in the node; the root's, where it goes on.
DVec3 direction_of(const Tree& tree, NodeId id) {
    const Node& node = tree.node(id);
    const NodeId other = node.parent != kNoNode ? node.parent : node.first_child;
    if (other == kNoNode) return DVec3(0.0);
    const DVec3 way = node.position - tree.node(other).position;
    return normalized_or(node.parent != kNoNode ? way : -way, DVec3(0.0));
}

// What stands behind the '@'. False: it is no place.
bool read_place(const ScanFrame& frame, std::string_view text, NamedPlace& place) {
    if (const auto three = read_numbers(text, ':', 3)) {
        place.place = frame.to_tree({(*three)[0], (*three)[1], (*three)[2]});
    } else if (const auto seven = read_numbers(text, ':', 7)) {
        place.place = frame.to_tree({(*seven)[0], (*seven)[1], (*seven)[2]});
        place.direction =
            normalized_or(frame.turn_to_tree({(*seven)[3], (*seven)[4], (*seven)[5]}), DVec3(0.0));
        place.radius = std::max((*seven)[6] * frame.metres_per_unit, 0.0);
    } else {
        return false;
    }
    return is_finite(place.place);
}

Address parse_address(const Tree& tree, std::string_view text) {
    const Error wrong(quote_word(text) + " names no node: write an id, 'root', or '@x:y:z'.");
    Address address;
    const size_t at = text.find('@');
    const std::string_view name = text.substr(0, at);
    if (name == "root") {
        if (tree.empty()) throw Misfit("The tree is empty.");
        address.id = tree.root();
    } else if (!name.empty()) {
        NodeId id = 0;
        const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), id);
        if (failure != std::errc() || end != name.data() + name.size()) throw wrong;
        address.id = id;
    }
    if (at == std::string_view::npos) {
        if (!address.id) throw wrong;
        return address;
    }
    NamedPlace place;
    if (!read_place(tree.frame(), text.substr(at + 1), place)) throw wrong;
    address.place = place.place;
    address.direction = place.direction;
    address.radius = place.radius;
    return address;
}

std::string metres_text(double metres) {
    char buffer[32];
    const auto result =
        metres < 1.0
            ? std::to_chars(buffer, buffer + sizeof buffer, 100.0 * metres, std::chars_format::general, 3)
            : std::to_chars(buffer, buffer + sizeof buffer, metres, std::chars_format::general, 4);
    return std::string(buffer, result.ptr) + (metres < 1.0 ? " cm" : " m");
}

void append_fixed(std::string& text, double value, int decimals) {
    char buffer[400];
    const auto result =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals);
    text.append(buffer, result.ptr);
}

}  // namespace

NodeId find_node(const Tree& tree, std::string_view text, double tolerance) {
    const Address address = parse_address(tree, text);
    if (!address.place) {
        if (!tree.contains(*address.id))
            throw Misfit("There is no node " + std::to_string(*address.id) + " in this tree.");
        return *address.id;
    }
    const DVec3 place = *address.place;
    if (address.id && tree.contains(*address.id) &&
        glm::distance(tree.node(*address.id).position, place) <= kSamePlace)
        return *address.id;
    const bool nearest_of_all = address.radius <= 0.0 && !address.id && tolerance <= 0.0;
    if (tolerance <= 0.0)
        tolerance = std::max(kHeightShare * tree.bounds().size().y, 2.0 * kDiameters * address.radius);
    NodeId best = kNoNode;
    double least = std::numeric_limits<double>::infinity();
    for (NodeId id = 0; id < tree.id_end(); id++) {
        if (!tree.contains(id)) continue;
        const Node& node = tree.node(id);
        const double distance = glm::distance(node.position, place);
        if (nearest_of_all) {
            if (distance < least) {
                least = distance;
                best = id;
            }
            continue;
        }
        // Nodes stand elsewhere along the wood after a new reconstruction: the wood must be near.
        double length = 0.0, gap = distance;
        const auto measure = [&](NodeId other) {
            const DVec3 end = tree.node(other).position;
            gap = std::min(gap, distance_to_segment(place, node.position, end));
            length = std::max(length, glm::distance(node.position, end));
        };
        if (node.parent != kNoNode) measure(node.parent);
        for (const NodeId child : tree.children(id))
            measure(child);
        if (gap > tolerance) continue;
        // Without a direction on either side there is nothing to compare.
        const DVec3 direction = direction_of(tree, id);
        const bool directed = address.direction != DVec3(0.0) && direction != DVec3(0.0);
        const double cosine = directed ? glm::dot(address.direction, direction) : kLeastCosine;
        if (cosine < kLeastCosine) continue;
        double thickness = 0.0;
        if (address.radius > 0.0) {
            thickness =
                std::abs(portable::log(node.radius / address.radius)) / portable::log(kMostRadiusRatio);
            if (thickness > 1.0) continue;
        }
        const double score =
            distance / (tolerance + length) + 0.5 * gap / tolerance + 0.5 * (1.0 - cosine) + 0.5 * thickness;
        if (score < least) {
            least = score;
            best = id;
        }
    }
    if (best == kNoNode) {
        std::string what = address.radius > 0.0 ? "wood of " + metres_text(2.0 * address.radius) +
                                                      " diameter that runs that way"
                                                : "wood";
        const std::string name(text.substr(0, text.find('@')));
        throw Misfit("There is no " + what + " within " + metres_text(tolerance) + " of " +
                     (name.empty() ? "that place." : "the place of node " + name + "."));
    }
    return best;
}

std::vector<NamedPlace> places_named(const ScanFrame& frame, std::string_view command) {
    std::vector<NamedPlace> places;
    for (size_t at = command.find('@'); at != std::string_view::npos; at = command.find('@', at + 1)) {
        const size_t end = std::min(command.find_first_of(" \t,&", at), command.size());
        NamedPlace place;
        if (read_place(frame, command.substr(at + 1, end - at - 1), place)) places.push_back(place);
    }
    return places;
}

std::string address_of(const Tree& tree, NodeId id) {
    const Node& node = tree.node(id);
    const ScanFrame& frame = tree.frame();
    const int decimals =
        std::clamp(static_cast<int>(std::ceil(portable::log10(frame.metres_per_unit / kFinestPlace))), 0, 15);
    const DVec3 place = frame.to_scan(node.position);
    const DVec3 direction = frame.turn_to_scan(direction_of(tree, id));
    std::string text = std::to_string(id) + "@";
    for (int axis = 0; axis < 3; axis++) {
        append_fixed(text, place[axis], decimals);
        text += ':';
    }
    for (int axis = 0; axis < 3; axis++) {
        append_fixed(text, direction[axis], 3);
        text += ':';
    }
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, frame.length_to_scan(node.radius),
                                      std::chars_format::general, 4);
    return text.append(buffer, result.ptr);
}

}  // namespace treerec
