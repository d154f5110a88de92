#include "edit/select.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "edit/commands/address.h"
#include "edit/commands/command_text.h"
#include "tree/branches.h"

namespace treerec {

namespace {

using Mask = std::vector<uint8_t>;  // by node id

template <typename F>
std::vector<NodeId> select_where(const Tree& tree, const F& wanted) {
    std::vector<NodeId> ids = tree.depth_first();
    std::erase_if(ids, [&](NodeId id) { return !wanted(id); });
    return ids;
}

// "2", "1..3", "2..", "..3".
std::optional<std::pair<double, double>> read_range(std::string_view text) {
    const size_t dots = text.find("..");
    if (dots == std::string_view::npos) {
        const std::optional<double> one = read_number(text);
        return one ? std::optional(std::pair(*one, *one)) : std::nullopt;
    }
    const std::string_view low = text.substr(0, dots), high = text.substr(dots + 2);
    if (low.empty() && high.empty()) return std::nullopt;
    std::pair<double, double> range(-kNoLimit, kNoLimit);
    if (!low.empty()) {
        const std::optional<double> number = read_number(low);
        if (!number) return std::nullopt;
        range.first = *number;
    }
    if (!high.empty()) {
        const std::optional<double> number = read_number(high);
        if (!number) return std::nullopt;
        range.second = *number;
    }
    if (range.first > range.second) return std::nullopt;
    return range;
}

std::string range_text(std::pair<double, double> range) {
    if (range.first == range.second) return number_text(range.first);
    return (range.first == -kNoLimit ? "" : number_text(range.first)) + ".." +
           (range.second == kNoLimit ? "" : number_text(range.second));
}

class Parser {
  public:
    Parser(const Tree& tree, std::string_view text, const SelectOptions& options)
        : tree_(tree), text_(text), options_(options) {}

    Selection parse() {
        Mask chosen(static_cast<size_t>(tree_.id_end()), 0);
        std::optional<Misfit> misfit;
        Selection selection;
        size_t column = 1;
        for (const std::string_view either : split(text_, ',')) {
            const size_t length = out_.size();
            selection.named++;
            try {
                const Mask part = term(either, column);
                for (size_t i = 0; i < part.size(); i++)
                    chosen[i] |= part[i];
            } catch (const Misfit& error) {
                if (!options_.keep_going) throw;
                if (!misfit) misfit = error;
                selection.missing++;
                out_.resize(length);
            }
            column += either.size() + 1;
        }
        if (selection.missing == selection.named) throw *misfit;
        out_.pop_back();
        selection.ids = select_where(tree_, [&](NodeId id) { return chosen[id] != 0; });
        selection.text = nodes_alone_ && selection.ids.size() > 1 ? by_branches(selection.ids, chosen) : out_;
        return selection;
    }

  private:
    // What '&' joins, written with a ',' behind it.
    Mask term(std::string_view text, size_t column) {
        Mask all;
        for (const std::string_view both : split(text, '&')) {
            const Mask one = factor(both, column);
            column += both.size() + 1;
            if (all.empty())
                all = one;
            else
                for (size_t i = 0; i < all.size(); i++)
                    all[i] &= one[i];
            out_ += '&';
        }
        out_.back() = ',';
        return all;
    }

    // The same nodes: those below which all are chosen by the lowest one, the others one by one.
    std::string by_branches(const std::vector<NodeId>& ids, const Mask& chosen) const {
        Mask whole = chosen;
        for (auto id = ids.rbegin(); id != ids.rend(); ++id)
            for (const NodeId child : tree_.children(*id))
                whole[*id] &= whole[child];
        std::string text;
        for (const NodeId id : ids) {
            const Node& node = tree_.node(id);
            if (node.parent != kNoNode && whole[node.parent]) continue;
            if (!text.empty()) text += ',';
            if (whole[id] && node.first_child != kNoNode) text += "below:";
            text += address_of(tree_, id);
        }
        return text;
    }

    Mask mask_of(const std::vector<NodeId>& ids) const {
        Mask mask(static_cast<size_t>(tree_.id_end()), 0);
        for (const NodeId id : ids)
            mask[id] = 1;
        return mask;
    }

    template <typename F>
    Mask mask_where(const F& wanted) const {
        Mask mask(static_cast<size_t>(tree_.id_end()), 0);
        for (NodeId id = 0; id < tree_.id_end(); id++)
            mask[id] = tree_.contains(id) && wanted(id);
        return mask;
    }

    NodeId node_at(std::string_view address, size_t column) {
        try {
            const NodeId id = find_node(tree_, address, options_.tolerance);
            out_ += address == "root" ? "root" : address_of(tree_, id);
            return id;
        } catch (const Misfit&) {
            throw;
        } catch (const Error& error) {
            throw CommandError(error.what(), column);
        }
    }

    double length(double metres) const {
        return options_.written_in ? length_between(*options_.written_in, tree_.frame(), metres) : metres;
    }
    DVec3 point(const DVec3& p) const {
        return options_.written_in ? point_between(*options_.written_in, tree_.frame(), p) : p;
    }
    DVec3 direction(const DVec3& v) const {
        return options_.written_in ? direction_between(*options_.written_in, tree_.frame(), v) : v;
    }

    std::optional<Mask> named(std::string_view name) const {
        const auto flagged = [&](uint8_t flag, bool on) {
            return mask_where([&](NodeId id) { return ((tree_.node(id).flags & flag) != 0) == on; });
        };
        if (name == "all") return mask_where([](NodeId) { return true; });
        if (name == "leaves") return mask_of(select_by_kind(tree_, NodeKind::kLeaf));
        if (name == "forks") return mask_of(select_by_kind(tree_, NodeKind::kBranch));
        if (name == "common") return mask_of(select_by_kind(tree_, NodeKind::kCommon));
        if (name == "trunk") return flagged(kTrunkFlag, true);
        if (name == "measured") return flagged(kMeasuredRadiusFlag, true);
        if (name == "inferred") return flagged(kMeasuredRadiusFlag, false);
        if (name == "guesses") return flagged(kGuessFlag, true);
        return std::nullopt;
    }

    std::optional<Mask> ranged(std::string_view name, std::string_view values, size_t column) {
        if (name != "order" && name != "depth" && name != "radius" && name != "height") return std::nullopt;
        std::optional<std::pair<double, double>> range = read_range(values);
        if (!range)
            throw CommandError(quote_word(values) + " is no range: write 2, 1..3, 2.. or ..3.", column);
        if (name == "radius" || name == "height") *range = {length(range->first), length(range->second)};
        out_ += std::string(name) + ":" + range_text(*range);
        const auto within = [&](double value) { return value >= range->first && value <= range->second; };
        if (name == "order") {
            const BranchList list = list_branches(tree_);
            return mask_where([&](NodeId id) { return within(list.branches[list.branch_of[id]].order); });
        }
        if (name == "depth") return mask_where([&](NodeId id) { return within(tree_.node(id).depth); });
        if (name == "radius") return mask_where([&](NodeId id) { return within(tree_.node(id).radius); });
        const double base = tree_.empty() ? 0.0 : tree_.node(tree_.root()).position.y;
        return mask_where([&](NodeId id) { return within(tree_.node(id).position.y - base); });
    }

    std::optional<Mask> regional(std::string_view name, std::string_view values, size_t column) {
        const size_t count = name == "sphere" ? 4 : 6;
        if (name != "box" && name != "sphere" && name != "side") return std::nullopt;
        const std::optional<std::vector<double>> n = read_numbers(values, ':', count);
        if (!n)
            throw CommandError("'" + std::string(name) + "' takes " + std::to_string(count) +
                                   " numbers with ':' between them, not " + quote_word(values) + ".",
                               column);
        const DVec3 first = point({(*n)[0], (*n)[1], (*n)[2]});
        Region region;
        try {
            if (name == "sphere") region = Region::sphere(first, length((*n)[3]));
            if (name == "box") region = Region::box(first, point({(*n)[3], (*n)[4], (*n)[5]}));
            if (name == "side") region = Region::side(first, direction({(*n)[3], (*n)[4], (*n)[5]}));
        } catch (const Error& error) {
            throw CommandError(error.what(), column);
        }
        out_ += std::string(name) + ":" + vector_text(region.a, ':') + ":" +
                (name == "sphere" ? number_text(region.radius) : vector_text(region.b, ':'));
        return mask_of(select_inside(tree_, region));
    }

    Mask factor(std::string_view text, size_t column) {
        const bool others = !text.empty() && text.front() == '!';
        if (others) {
            nodes_alone_ = false;
            text.remove_prefix(1);
            column++;
            out_ += '!';
        }
        Mask mask = atom(text, column);
        if (others)
            for (NodeId id = 0; id < tree_.id_end(); id++)
                mask[id] = tree_.contains(id) && !mask[id];
        return mask;
    }

    Mask atom(std::string_view text, size_t column) {
        if (const std::optional<Mask> mask = named(text)) {
            nodes_alone_ = false;
            out_ += text;
            return *mask;
        }
        const size_t colon = text.find_first_of(":@");
        if (colon != std::string_view::npos && text[colon] == ':') {
            nodes_alone_ = false;
            const std::string_view name = text.substr(0, colon), rest = text.substr(colon + 1);
            const size_t place = column + colon + 1;
            if (const std::optional<Mask> mask = ranged(name, rest, place)) return *mask;
            if (const std::optional<Mask> mask = regional(name, rest, place)) return *mask;
            if (name == "below" || name == "branch" || name == "path") {
                out_ += std::string(name) + ":";
                const NodeId id = node_at(rest, place);
                if (name == "below") return mask_of(tree_.depth_first(id));
                return mask_of(name == "branch" ? select_branch(tree_, id) : select_path(tree_, id));
            }
            throw CommandError(
                "There is no selection '" + std::string(name) +
                    ":'; there are below branch path order depth radius height box sphere side.",
                column);
        }
        nodes_alone_ = nodes_alone_ && text != "root";
        return mask_of({node_at(text, column)});
    }

    const Tree& tree_;
    const std::string_view text_;
    const SelectOptions& options_;
    std::string out_;
    bool nodes_alone_ = true;  // so far
};

}  // namespace

std::vector<NodeId> select_by_kind(const Tree& tree, NodeKind kind) {
    return select_where(tree, [&](NodeId id) { return tree.node(id).kind() == kind; });
}

std::vector<NodeId> select_by_order(const Tree& tree, int least, int most) {
    const BranchList list = list_branches(tree);
    return select_where(tree, [&](NodeId id) {
        const int order = list.branches[list.branch_of[id]].order;
        return order >= least && order <= most;
    });
}

std::vector<NodeId> select_by_radius(const Tree& tree, double least, double most) {
    return select_where(
        tree, [&](NodeId id) { return tree.node(id).radius >= least && tree.node(id).radius <= most; });
}

std::vector<NodeId> select_inside(const Tree& tree, const Region& region) {
    return select_where(tree, [&](NodeId id) { return region.contains(tree.node(id).position); });
}

std::vector<NodeId> select_branch(const Tree& tree, NodeId id) {
    if (!tree.contains(id)) throw Error("There is no node " + std::to_string(id) + " in this tree.");
    const BranchList list = list_branches(tree);
    const std::span<const NodeId> nodes = list.nodes_of(list.branches[list.branch_of[id]]);
    return {nodes.begin(), nodes.end()};
}

std::vector<NodeId> select_path(const Tree& tree, NodeId id) {
    if (!tree.contains(id)) throw Error("There is no node " + std::to_string(id) + " in this tree.");
    std::vector<NodeId> path;
    for (NodeId at = id; at != kNoNode; at = tree.node(at).parent)
        path.push_back(at);
    std::reverse(path.begin(), path.end());
    return path;
}

Selection select(const Tree& tree, std::string_view text, const SelectOptions& options) {
    return Parser(tree, text, options).parse();
}

}  // namespace treerec
