#include "edit/vary/vary.h"

#include <algorithm>
#include <cmath>

#include "edit/vary/vary_parts.h"
#include "error.h"
#include "geometry/portable_trig.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// How much varies at an amount of 1. Angles in radians.
constexpr double kTrunkBend = 0.05;    // at its top
constexpr double kTrunkGrowth = 0.06;  // share of its length,
constexpr double kTrunkGauge = 0.06;   // and of its radii
constexpr double kBend = 0.16;         // of a branch at its tip
constexpr double kWave = 0.10;         // on its way
constexpr double kAround = 0.35;       // about the trunk, beside its twist,
constexpr double kAside = 0.22;        // and about a branch
constexpr double kFork = 0.10;         // of the angle with the parent
constexpr double kGrowth = 0.10;       // share of a branch's length,
constexpr double kGauge = 0.12;        // and of its radii
constexpr double kShift = 0.035;       // of the parent's length
constexpr double kReshaped = 0.85;     // share of branches that take another one's shape
constexpr double kMirrored = 0.5;      // and of those that are mirrored
constexpr double kLeftOut = 0.07;      // and of slender ones that are left out, or stand twice
constexpr double kSlender = 0.02;      // of the tree's wood, at most
constexpr double kWindow = 0.12;       // of the pool: how far the rank of another shape may be
constexpr int kTries = 6;

constexpr double kLeastDrift = 0.75, kMostDrift = 1.3;
constexpr double kShapeLength = 1.5, kShapeRadius = 2.5;  // at most, of another shape over one's own
constexpr double kShapeRise = 0.2;                        // the sines of the two elevations differ by no more
constexpr double kShapeTip = 0.35;  // of its length: how far its tip may be from where it was
constexpr double kBalance = 0.12;   // of the tree's nodes and wood: how far a variant may be from it
constexpr double kUpright = 0.8;    // the least rise of a trunk that branches turn about
constexpr double kRival = 0.4, kRivalRange = 0.35;  // thicker beside the leader, it turns less about it
constexpr int32_t kFewBranches = 8;                 // fewer tell nothing of their order alone
constexpr double kAllowance = 0.03;                 // outside of the observed ranges
constexpr double kMostRadius = 1.0;                 // at the joint, of the parent's

// A bell of standard deviation 1, between -3 and 3; no logarithm in it, so that it is the same everywhere.
double bell(Random& random) {
    return 2.0 * (random.uniform() + random.uniform() + random.uniform() - 1.5);
}

// The smallest rotation from one unit vector to another; without angles, for the same reason.
DMat3 turn_onto(const DVec3& from, const DVec3& to) {
    const double cosine = glm::dot(from, to);
    if (cosine < -0.99) {
        // Half a turn about something across.
        const DVec3 k = any_perpendicular(from);
        return DMat3(2.0 * k * k.x - DVec3(1, 0, 0), 2.0 * k * k.y - DVec3(0, 1, 0),
                     2.0 * k * k.z - DVec3(0, 0, 1));
    }
    const DVec3 v = glm::cross(from, to);
    const double s = 1.0 / (1.0 + cosine);
    return DMat3(DVec3(cosine + s * v.x * v.x, s * v.x * v.y + v.z, s * v.x * v.z - v.y),
                 DVec3(s * v.x * v.y - v.z, cosine + s * v.y * v.y, s * v.y * v.z + v.x),
                 DVec3(s * v.x * v.z + v.y, s * v.y * v.z - v.x, cosine + s * v.z * v.z));
}

DVec3 turned_about(const DVec3& axis, const SineCosine& by, const DVec3& v) {
    return v * by.cosine + glm::cross(axis, v) * by.sine + axis * (glm::dot(axis, v) * (1.0 - by.cosine));
}

DMat3 rotation(const DVec3& axis, double radians) {
    const SineCosine by = portable_sine_cosine(radians);
    return DMat3(turned_about(axis, by, {1, 0, 0}), turned_about(axis, by, {0, 1, 0}),
                 turned_about(axis, by, {0, 0, 1}));
}

// Axes that look along a way and know up: to its right, along it, up.
DMat3 standing_axes(const DVec3& way) {
    const DVec3 right = normalized_or(glm::cross(way, DVec3(0, 1, 0)), DVec3(1, 0, 0));
    return DMat3(right, way, glm::cross(right, way));
}

}  // namespace

void VariantMaker::Range::add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
}

VariantMaker::VariantMaker(const Tree& tree, const Foliage& foliage) : tree_(tree), foliage_(foliage) {
    if (tree.size() < 2) return;
    look_at_branches();
    look_at_habits();
    look_at_growth();
    if (!foliage.empty()) carry_foliage(foliage);
}

void VariantMaker::look_at_branches() {
    const BranchList list = list_branches(tree_);
    floor_ = tree_.node(tree_.root()).position.y;
    for (const NodeId id : list.nodes)
        floor_ = std::min(floor_, tree_.node(id).position.y);
    branches_.resize(list.branches.size());
    std::vector<int32_t> place(static_cast<size_t>(tree_.id_end()), -1);  // along its branch
    for (size_t b = 0; b < branches_.size(); b++) {
        const Branch& listed = list.branches[b];
        VariedBranch& branch = branches_[b];
        branch.parent = listed.parent;
        branch.order = listed.order;
        branch.begin = static_cast<int32_t>(steps_.size());
        const NodeId base = b == 0 ? tree_.root() : listed.attach;
        if (b > 0) branch.attach = place[base];
        DVec3 from = tree_.node(base).position;
        for (NodeId id : list.nodes_of(listed)) {
            if (id == tree_.root()) continue;
            const Node& node = tree_.node(id);
            const DVec3 step = node.position - from;
            const double length = glm::length(step);
            branch.length += length;
            place[id] = static_cast<int32_t>(steps_.size()) - branch.begin;
            steps_.push_back(step);
            lengths_.push_back(length);
            along_.push_back(branch.length);
            radii_.push_back(node.radius);
            flags_.push_back(node.flags & kTrunkFlag);
            leaf_rules_.push_back(node.leaf_rule);
            sections_.push_back(node.section);
            branch.stem = branch.stem || node.is_trunk();
            if (place[id] == 0) branch.least_rule = branch.most_rule = node.leaf_rule;
            branch.least_rule = std::min(branch.least_rule, node.leaf_rule);
            branch.most_rule = std::max(branch.most_rule, node.leaf_rule);
            from = node.position;
        }
        branch.end = static_cast<int32_t>(steps_.size());
        branch.nodes = branch.end - branch.begin;
        branch.wood = branch.length;
        branch.radius = radii_[branch.begin];
        const DVec3 start = tree_.node(base).position;
        const auto middle = std::lower_bound(along_.begin() + branch.begin, along_.begin() + branch.end - 1,
                                             0.5 * branch.length) -
                            along_.begin();
        DVec3 way(0.0);
        for (int32_t k = branch.begin; k <= static_cast<int32_t>(middle); k++)
            way += steps_[k];
        branch.way = normalized_or(way, normalized_or(from - start, DVec3(0, 1, 0)));
        branch.reach = from - start;
        branch.axes = standing_axes(branch.way);
        branch.reach_in_axes = branch.reach * branch.axes;
        if (b == 0) continue;
        const VariedBranch& parent = branches_[branch.parent];
        const int32_t joint = parent.begin + branch.attach;
        DVec3 axis = branch.attach >= 0 ? steps_[joint] : DVec3(0.0);
        if (joint + 1 < parent.end) {
            axis += steps_[joint + 1];
            branch.beside = branch.radius / radii_[joint + 1];
        }
        branch.axis = normalized_or(axis, parent.way);
    }
    // Children stand behind their parents, in order along them; all of one branch one after another.
    for (size_t b = branches_.size(); b-- > 1;) {
        VariedBranch& parent = branches_[branches_[b].parent];
        parent.nodes += branches_[b].nodes;
        parent.wood += branches_[b].wood;
        parent.stem = parent.stem || branches_[b].stem;
        parent.least_rule = std::min(parent.least_rule, branches_[b].least_rule);
        parent.most_rule = std::max(parent.most_rule, branches_[b].most_rule);
        parent.first_child = static_cast<int32_t>(b);
        if (parent.last_child == 0) parent.last_child = static_cast<int32_t>(b) + 1;
    }
}

double VariantMaker::parent_radius(const VariedBranch& branch) const {
    return branch.attach < 0 ? tree_.node(tree_.root()).radius
                             : radii_[branches_[branch.parent].begin + branch.attach];
}

void VariantMaker::look_at_habits() {
    Habit all;
    for (size_t b = 1; b < branches_.size(); b++) {
        const VariedBranch& branch = branches_[b];
        if (static_cast<size_t>(branch.order) >= habits_.size()) habits_.resize(branch.order + size_t{1});
        const double parent_length = branches_[branch.parent].length;
        for (Habit* habit : {&all, &habits_[branch.order]}) {
            habit->branches++;
            habit->cosine.add(glm::dot(branch.axis, branch.way));
            if (parent_length > 0.0) habit->length.add(branch.length / parent_length);
            habit->radius.add(branch.radius / parent_radius(branch));
        }
        habits_[branch.order].pool.push_back(static_cast<int32_t>(b));
    }
    for (Habit& habit : habits_) {
        std::stable_sort(habit.pool.begin(), habit.pool.end(),
                         [&](int32_t a, int32_t b) { return branches_[a].length < branches_[b].length; });
        for (size_t i = 0; i < habit.pool.size(); i++)
            branches_[habit.pool[i]].rank = static_cast<int32_t>(i);
        if (habit.branches >= kFewBranches) continue;
        habit.cosine = all.cosine;
        habit.length = all.length;
        habit.radius = all.radius;
    }
}

TreeVariant VariantMaker::make(uint64_t seed, double amount, double age) const {
    if (!(amount >= 0.0 && amount <= 1.0)) throw Error("The amount of variation must be 0 to 1.");
    if (!(age >= kLeastAge && age <= kMostAge))
        throw Error("The age of a variant must be 0.2 to 1.2 of the tree's own.");
    if ((amount == 0.0 && age == 1.0) || tree_.size() < 2) return {tree_, foliage_};
    Work work;
    work.amount = amount;
    set_age(work, age);
    const size_t expected = tree_.size() + tree_.size() / 4;
    work.positions.reserve(expected);
    work.radii.reserve(expected);
    work.parents.reserve(expected);
    work.flags.reserve(expected);
    work.leaf_rules.reserve(expected);
    work.sections.reserve(expected);
    work.slots.reserve(branches_.size() + branches_.size() / 4);
    Random random(seed, 7);
    work.twist_start = kPi * amount * random.uniform(-1.0, 1.0);
    work.twist_even = 0.5 * kPi * amount * random.uniform(-1.0, 1.0);
    work.twist_swing = 0.25 * kPi * amount * random.uniform(-1.0, 1.0);
    Slot trunk;
    trunk.drift = trunk.scale = 1.0 + kTrunkGrowth * amount * random.uniform(-1.7, 1.7);
    trunk.gauge = trunk.scale * (1.0 + kTrunkGauge * amount * random.uniform(-1.7, 1.7));
    trunk.scale *= work.size;
    trunk.gauge *= work.gauge;
    trunk.key = hash_seed(seed, 0);
    const Node& root = tree_.node(tree_.root());
    trunk.base = root.position;
    trunk.parent = 0;
    work.positions.push_back(root.position);
    work.radii.push_back(root.radius * trunk.gauge);
    work.parents.push_back(kNoNode);
    work.flags.push_back(root.flags & kTrunkFlag);
    work.leaf_rules.push_back(root.leaf_rule);
    work.sections.push_back(root.section);
    work.slots.push_back(trunk);
    for (size_t i = 0; i < work.slots.size(); i++) {
        const Slot slot = work.slots[i];
        grow(work, slot);
    }
    TreeVariant variant;
    variant.tree = Tree::from_arrays(work.parents, work.positions, work.radii, work.flags);
    variant.tree.set_frame(tree_.frame());
    for (const std::string& rule : tree_.leaf_rules())
        variant.tree.name_leaf_rule(rule);
    variant.tree.set_section_table(tree_.section_table());
    for (NodeId id = 0; id < variant.tree.id_end(); id++) {
        variant.tree.set_leaf_rule(id, work.leaf_rules[id]);
        variant.tree.set_section(id, work.sections[id]);
    }
    if (!foliage_.empty()) variant.foliage = settle(work.cells, work.places);
    return variant;
}

// Sets the branch's own nodes and plans what it bears.
void VariantMaker::grow(Work& work, const Slot& slot) const {
    const VariedBranch& branch = branches_[slot.branch];
    const bool trunk = slot.branch == 0;
    Random random(slot.key);
    // Bends are small: a tilt across the way does for a turn, and needs no angles.
    // One after the other: compilers differ in which side of a sum they do first.
    const auto aside = [&](double most) {
        const DVec3 second = branch.axes[2] * bell(random);
        return (branch.axes[0] * bell(random) + second) * (0.7 * (work.amount * most));
    };
    const DVec3 arc = aside(trunk ? kTrunkBend : kBend), swing = aside(trunk ? kTrunkBend : kWave);
    const double over_length = branch.length > 0.0 ? 1.0 / branch.length : 0.0;
    const auto first = static_cast<NodeId>(work.positions.size());
    const size_t count = static_cast<size_t>(branch.end - branch.begin);
    work.tilts.resize(count);
    DVec3 at = slot.base;
    for (size_t k = 0; k < count; k++) {
        const size_t n = static_cast<size_t>(branch.begin) + k;
        const double t = (along_[n] - 0.5 * lengths_[n]) * over_length;
        // The swing is 0 at both ends and in the middle.
        const DVec3 tilt = arc * t + swing * (10.0 * t * (1.0 - t) * (1.0 - 2.0 * t));
        const DVec3 step = steps_[n] + tilt * lengths_[n];
        const double length = glm::length(step);
        const double same = length > 0.0 ? lengths_[n] / length : 1.0;
        at += slot.turn * (step * (same * slot.scale));
        at.y = std::max(at.y, floor_);
        work.tilts[k] = tilt;
        work.positions.push_back(at);
        const NodeId parent = k == 0 ? slot.parent : first + static_cast<NodeId>(k) - 1;
        double radius = radii_[n] * slot.gauge;
        // Twigs are as thick on a young tree.
        if (work.size < 1.0)
            radius = std::max(radius, std::min({radii_[n], twig_radius_, work.radii[parent]}));
        work.radii.push_back(radius);
        work.parents.push_back(parent);
        work.flags.push_back(flags_[n]);
        work.leaf_rules.push_back(leaf_rules_[n]);
        work.sections.push_back(sections_[n]);
    }
    for (int32_t child = branch.first_child; child < branch.last_child; child++) {
        const uint64_t key = hash_seed(slot.key, 2 * static_cast<uint64_t>(child - branch.first_child) + 2);
        bear(work, slot, child, key, false);
    }
    if (carried_.empty()) return;
    for (int32_t c = carried_begin_[slot.branch]; c < carried_begin_[slot.branch + 1]; c++) {
        const Carried& one = carried_[c];
        // As dense as they are, in a smaller crown.
        if (work.size < 1.0 &&
            static_cast<double>(hash_seed(slot.key, one.cell) >> 11) * 0x1p-53 >= work.size * work.size)
            continue;
        const DVec3 from = one.node < 0 ? slot.base : work.positions[first + one.node];
        work.cells.push_back(one.cell);
        work.places.push_back(from + slot.turn * one.offset * slot.scale);
    }
}

// Plans one child of a branch that has its nodes: where it stands, whose shape it takes, which way it goes.
void VariantMaker::bear(Work& work, const Slot& slot, int32_t child, uint64_t key, bool again) const {
    const VariedBranch& branch = branches_[slot.branch];
    const VariedBranch& own = branches_[child];
    const double amount = work.amount;
    Random random(key, 1);
    const auto first = static_cast<NodeId>(work.positions.size()) - (branch.end - branch.begin);

    if (!again && is_yet_to_grow(work, own, key)) return;
    const double fate = random.uniform();
    if (!again && is_left_out(work, slot, child, key, fate)) return;

    // Stout branches keep their place beside the leader, further stems all the more.
    const double slim = own.stem ? 0.0 : std::clamp(1.0 - (own.beside - kRival) / kRivalRange, 0.0, 1.0);
    const int32_t joint =
        own.attach < 0 ? own.attach : find_joint(branch, own, (again ? 3.0 : 1.0) * slim, amount, random);
    Slot next;
    next.parent = joint < 0 ? slot.parent : first + joint;
    next.base = joint < 0 ? slot.base : work.positions[next.parent];
    DVec3 way(0.0);
    next.turn = turn_at(work, slot, own, joint, next.parent, slim, again, random, way);

    // Whose shape.
    next.branch = !own.stem && random.uniform() < kReshaped * std::min(1.0, 1.5 * amount)
                      ? choose_shape(work, child, next.turn, way, key)
                      : child;
    const bool mirrored = !own.stem && random.uniform() < kMirrored * std::min(1.0, 2.0 * amount);
    const DMat3 axes = next.branch != child || mirrored ? standing_axes(way) : DMat3(1.0);
    if (next.branch != child) next.turn = axes * glm::transpose(branches_[next.branch].axes);
    if (mirrored) {
        const DVec3& right = axes[0];
        const DMat3 turn = next.turn;
        next.turn =
            turn - DMat3(2.0 * right * glm::dot(right, turn[0]), 2.0 * right * glm::dot(right, turn[1]),
                         2.0 * right * glm::dot(right, turn[2]));
    }
    set_size(work, slot, own, random, next);
    next.key = hash_seed(key, 1);
    work.slots.push_back(next);
}

// Whether a slender child is not there in this variant, or, elsewhere, twice: what the one takes of the wood
// the other gives. fate: 0..1, by chance.
bool VariantMaker::is_left_out(Work& work, const Slot& slot, int32_t child, uint64_t key, double fate) const {
    const VariedBranch& own = branches_[child];
    if (own.stem || own.wood >= kSlender * branches_[0].wood || own.order <= 1) return false;
    if (fate < kLeftOut * work.amount && work.more_wood > -kBalance * branches_[0].wood) {
        work.more_nodes -= own.nodes;
        work.more_wood -= own.wood;
        return true;
    }
    if (fate > 1.0 - kLeftOut * work.amount && work.more_wood < kBalance * branches_[0].wood &&
        work.more_nodes < kBalance * branches_[0].nodes) {
        work.more_nodes += own.nodes;
        work.more_wood += own.wood;
        bear(work, slot, child, key + 1, true);
    }
    return false;
}

// By the parent's nodes, where a child that is attached to one stands: not below the lowest of its siblings,
// nor at the tip. share, amount: how far it may move.
int32_t VariantMaker::find_joint(const VariedBranch& parent, const VariedBranch& own, double share,
                                 double amount, Random& random) const {
    int32_t joint = own.attach;
    // What is low on its parent moves less.
    const double own_along = along_[parent.begin + joint];
    const double reach = share * kShift * amount * std::min(parent.length, 3.0 * own_along);
    const double wanted = own_along + reach * std::clamp(bell(random), -2.0, 2.0);
    const int32_t lowest = std::max(branches_[parent.first_child].attach, 0);
    const int32_t highest = std::max(parent.end - parent.begin - 2, joint);
    while (joint < highest && along_[parent.begin + joint + 1] <= wanted)
        joint++;
    while (joint > lowest && along_[parent.begin + joint] > wanted)
        joint--;
    return joint;
}

// Which way a child goes, `way`, and the turn that takes its own way there: with its parent, about it, and at
// another angle. joint: by the parent's nodes, which is `node` of the variant.
DMat3 VariantMaker::turn_at(const Work& work, const Slot& slot, const VariedBranch& own, int32_t joint,
                            NodeId node, double slim, bool again, Random& random, DVec3& way) const {
    const VariedBranch& branch = branches_[slot.branch];
    const double amount = work.amount;
    DMat3 turn = slot.turn;
    if (joint >= 0) turn = turn * turn_onto(own.axis, normalized_or(own.axis + work.tilts[joint], own.axis));
    DVec3 axis = turn * own.axis;
    if (joint >= 0) {
        axis = work.positions[node] - work.positions[joint > 0 ? node - 1 : slot.parent];
        if (joint + 1 < branch.end - branch.begin) axis += work.positions[node + 1] - work.positions[node];
    }
    axis = normalized_or(axis, normalized_or(turn * own.axis, DVec3(0, 1, 0)));
    const double jitter = amount * bell(random);
    if (slot.branch == 0 && axis.y > kUpright) {
        const double share =
            joint < 0 || !(branch.length > 0.0) ? 0.0 : along_[branch.begin + joint] / branch.length;
        const double swing = 10.0 * share * (1.0 - share) * (1.0 - 2.0 * share);
        const double twist = work.twist_start + work.twist_even * share + work.twist_swing * swing;
        const double around =
            slim * twist + (0.2 + 0.8 * slim) * kAround * jitter + (again ? random.uniform(-kPi, kPi) : 0.0);
        turn = rotation({0, 1, 0}, around) * turn;
    } else {
        const double around =
            (0.2 + 0.8 * slim) * kAside * jitter + (again && random.uniform() < 0.5 ? kPi : 0.0);
        turn = rotation(axis, around) * turn;
    }
    way = normalized_or(turn * own.way, axis);
    // At another angle, as far as this order of branches goes. A tilt again, for a turn.
    const double cosine = glm::dot(axis, way);
    const DVec3 across = way - axis * cosine;
    if (glm::dot(across, across) <= 1e-6) return turn;
    const Range& usual = habits_[own.order].cosine;
    const DVec3 aside = glm::normalize(across);
    const double fork = kFork * amount * bell(random);
    const DVec3 tilted = way + (aside * cosine - axis * glm::dot(aside, way)) * fork;
    const double wanted = std::clamp(glm::dot(axis, glm::normalize(tilted)), usual.least, usual.most);
    const double bounded = std::clamp(wanted, -1.0, 1.0);
    const DVec3 forked =
        glm::normalize(axis * bounded + aside * std::sqrt(std::max(0.0, 1.0 - bounded * bounded)));
    turn = turn_onto(way, forked) * turn;
    way = forked;
    return turn;
}

// How long and how thick the child is in the shape that `next` takes: as the one whose place it takes, but
// for its own growth; and no thicker than its parent there.
void VariantMaker::set_size(const Work& work, const Slot& slot, const VariedBranch& own, Random& random,
                            Slot& next) const {
    const VariedBranch& shape = branches_[next.branch];
    const Habit& habit = habits_[own.order];
    const double amount = work.amount;
    next.drift = std::clamp(slot.drift * (1.0 + kGrowth * amount * std::clamp(bell(random), -2.0, 2.0)),
                            kLeastDrift, kMostDrift);
    const double growth = next.drift / slot.drift;
    double length = own.length * slot.scale * growth;
    const double parent_length = branches_[slot.branch].length * slot.scale;
    if (parent_length > 0.0 && habit.length.most > 0.0)
        length = std::clamp(length, parent_length * habit.length.least * (1.0 - kAllowance),
                            parent_length * habit.length.most * (1.0 + kAllowance));
    next.scale = shape.length > 0.0 ? length / shape.length : slot.scale;

    const double thick = work.radii[next.parent];
    const double own_share = own.radius / parent_radius(own);
    double radius =
        own.radius * slot.gauge * growth * (1.0 + kGauge * amount * std::clamp(bell(random), -2.0, 2.0));
    const double most = std::max(own_share, std::min(kMostRadius, habit.radius.most)) * thick;
    const double least = habit.radius.least * (1.0 - kAllowance) * thick;
    radius = std::min(std::max(radius, std::min(least, most)), most);
    next.gauge = radius / shape.radius;
}

// Another branch of the child's order and about its length, or the child itself.
int32_t VariantMaker::choose_shape(Work& work, int32_t child, const DMat3& turn, const DVec3& way,
                                   uint64_t key) const {
    const VariedBranch& own = branches_[child];
    const std::vector<int32_t>& pool = habits_[own.order].pool;
    const auto size = static_cast<int32_t>(pool.size());
    Random random(key, 2);
    const int32_t window = std::max(2, static_cast<int32_t>(kWindow * work.amount * size) + 1);
    const DVec3 tip = turn * own.reach;
    const DMat3 axes = standing_axes(way);
    const auto fits = [](double more, double limit, double change) {
        return std::abs(more + change) <= limit || std::abs(more + change) <= std::abs(more);
    };
    for (int tries = 0; tries < kTries; tries++) {
        const int32_t rank =
            own.rank - window + static_cast<int32_t>(random.below(2 * static_cast<uint32_t>(window) + 1));
        if (rank < 0 || rank >= size || rank == own.rank) continue;
        const int32_t other = pool[rank];
        const VariedBranch& shape = branches_[other];
        if (shape.stem || shape.least_rule != own.least_rule || shape.most_rule != own.most_rule) continue;
        if (!(shape.length < kShapeLength * own.length && own.length < kShapeLength * shape.length)) continue;
        if (!(shape.radius < kShapeRadius * own.radius && own.radius < kShapeRadius * shape.radius)) continue;
        if (std::abs(shape.way.y - way.y) > kShapeRise) continue;
        const double nodes = shape.nodes - own.nodes, wood = shape.wood - own.wood;
        if (!fits(work.more_nodes, kBalance * branches_[0].nodes, nodes)) continue;
        if (!fits(work.more_wood, kBalance * branches_[0].wood, wood)) continue;
        const DVec3 there = axes * shape.reach_in_axes * (own.length / shape.length);
        if (glm::distance(tip, there) > kShapeTip * own.length) continue;
        work.more_nodes += nodes;
        work.more_wood += wood;
        return other;
    }
    return child;
}

}  // namespace treerec
