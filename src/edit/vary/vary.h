// New individuals of one tree's kind, made from its own branches.
#pragma once

#include <cstdint>
#include <vector>

#include "foliage/foliage.h"
#include "geometry/random.h"
#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

struct TreeVariant {
    Tree tree;        // ids 0.., parents first; the frame of the original
    Foliage foliage;  // what the scan saw of leaves, carried along by the wood it was nearest to
};

// Looks at a tree once, for any number of variants.
//
// A variant keeps the trunk's line, roughly. Every branch may change its place along its parent, turn about
// it, change its angle, bend, be mirrored, and take the shape, with all that it bears, of another branch of
// its order and about its length; slender ones may be left out or stand twice. Branches keep what they
// have of up and down. Angles with the parent, lengths and radii at the joint over the parent's stay within
// what the tree itself shows at that order of branches; the number of nodes and the length of wood stay
// within about a sixth of the tree's, and nothing goes below its lowest node.
class VariantMaker {
  public:
    explicit VariantMaker(const Tree& tree, const Foliage& foliage = {});

    // amount: 0 (the same tree, bit for bit, at an age of 1) .. 1. age: kLeastAge .. kMostAge of the tree's
    // own (vary_age.cpp says what it makes of one). The same seed, amount and age give the same bytes on
    // every platform. Leaf rules stay where they are: a branch takes shapes of its own rules alone. Any
    // number of threads may call it at once. Linear in the nodes and the cells of foliage. Of the flags only
    // kTrunkFlag is left: nothing of a variant was measured. Throws Error for another amount or age.
    TreeVariant make(uint64_t seed, double amount, double age = 1.0) const;

    static constexpr double kLeastAge = 0.2, kMostAge = 1.2;

    // How thick a branch of this tree is for its length: radius = constant * length^this.
    double allometry() const { return allometry_; }

  private:
    // A branch (tree/branches.h) from its base, the node of its parent that it grows from; the first one's is
    // the root. Its nodes are begin..end-1 of the arrays below.
    struct VariedBranch {
        int32_t parent = -1;
        int32_t order = 0;
        int32_t attach = -1;  // by the parent's nodes, from 0; -1: at the parent's base
        int32_t begin = 0, end = 0;
        int32_t first_child = 0, last_child = 0;  // branches that grow from it, by their place along it
        int32_t rank = 0;                         // in the pool of its order
        int32_t nodes = 0;                        // with all that it bears
        double wood = 0.0;                        // metres, likewise
        bool stem = false;                        // there is trunk in it or in what it bears
        uint8_t least_rule = 0, most_rule = 0;    // of the leaf rules in it and in what it bears
        double length = 0.0;
        double radius = 0.0;  // of its first node
        double beside = 0.0;  // that over the radius of what goes on from the joint; 0 where nothing does
        DVec3 way{0.0, 1.0, 0.0};   // unit, from the base to the middle
        DVec3 axis{0.0, 1.0, 0.0};  // unit, of the parent at the base
        DVec3 reach{0.0};           // from the base to the tip
        DMat3 axes{1.0};            // to the right of the way, along it, up
        DVec3 reach_in_axes{0.0};
    };
    struct Range {
        double least = 1e300, most = -1e300;
        void add(double value);
        bool holds(double value) const { return value >= least && value <= most; }
    };
    // What branches of one order are like.
    struct Habit {
        int32_t branches = 0;
        Range cosine;               // of the angle with the parent
        Range length;               // over the parent's
        Range radius;               // over the parent's at the joint
        std::vector<int32_t> pool;  // by rising length
    };
    // A cell of foliage, by the wood it is nearest to.
    struct Carried {
        int32_t node = 0;  // in the arrays; -1: the branch's base
        uint32_t cell = 0;
        DVec3 offset{0.0};  // from there, metres
    };
    struct Slot;
    struct Work;

    void look_at_branches();
    void look_at_habits();
    void look_at_growth();
    void set_age(Work& work, double age) const;
    bool is_yet_to_grow(const Work& work, const VariedBranch& branch, uint64_t key) const;
    void carry_foliage(const Foliage& foliage);
    double parent_radius(const VariedBranch& branch) const;
    void grow(Work& work, const Slot& slot) const;
    void bear(Work& work, const Slot& slot, int32_t child, uint64_t key, bool again) const;
    bool is_left_out(Work& work, const Slot& slot, int32_t child, uint64_t key, double fate) const;
    int32_t find_joint(const VariedBranch& parent, const VariedBranch& own, double share, double amount,
                       Random& random) const;
    DMat3 turn_at(const Work& work, const Slot& slot, const VariedBranch& own, int32_t joint, NodeId node,
                  double slim, bool again, Random& random, DVec3& way) const;
    void set_size(const Work& work, const Slot& slot, const VariedBranch& own, Random& random,
                  Slot& next) const;
    int32_t choose_shape(Work& work, int32_t child, const DMat3& turn, const DVec3& way, uint64_t key) const;
    Foliage settle(const std::vector<uint32_t>& cells, const std::vector<DVec3>& places) const;

    Tree tree_;
    Foliage foliage_;
    double floor_ = 0.0;  // the lowest node
    // What this tree shows of growth: see vary_age.cpp. Metres.
    double allometry_ = 1.5;
    double twig_length_ = 0.0, twig_radius_ = 0.0;
    std::vector<VariedBranch> branches_;
    std::vector<Habit> habits_;  // by order
    // By node of the branches: the way from the node before (or the base), its length, the way along the
    // branch up to here, radius, flags and leaf rule.
    std::vector<DVec3> steps_;
    std::vector<double> lengths_, along_, radii_;
    std::vector<uint8_t> flags_, leaf_rules_;
    std::vector<uint16_t> sections_;
    std::vector<Carried> carried_;   // by branch
    std::vector<uint8_t> in_crowd_;  // by cell: others touch it
    std::vector<int32_t> carried_begin_;
};

}  // namespace treerec
