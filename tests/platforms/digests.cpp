// One line for each thing that a game makes of trees: what it is and a digest of its bytes. The same program,
// built for another system, must print the same lines.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "edit/commands/script.h"
#include "edit/vary/vary.h"
#include "foliage/leaves.h"
#include "geometry/random.h"
#include "lsystem/grammar.h"
#include "lsystem/lstring.h"
#include "mesh/branch_tubes.h"
#include "mesh/capsules.h"
#include "mesh/leaf_cards.h"
#include "mesh/level_leaves.h"
#include "synth/grow.h"

namespace treerec {
namespace {

// FNV-1a of 64 bits.
class Digest {
  public:
    void add(const void* data, size_t size) {
        for (const auto* at = static_cast<const unsigned char*>(data); size > 0; at++, size--)
            value_ = (value_ ^ *at) * 0x100000001b3ull;
    }
    void add(std::string_view text) { add(text.data(), text.size()); }
    template <typename T>
    requires std::is_arithmetic_v<T>
    void add(T value) { add(&value, sizeof value); }
    void add(const DVec3& v) { add(&v, sizeof v); }
    template <typename List>
    void add_all(const List& list) {
        add(list.data(), list.size() * sizeof list[0]);
    }
    void print(const std::string& what) const {
        std::printf("%-40s %016llx\n", what.c_str(), static_cast<unsigned long long>(value_));
    }

  private:
    uint64_t value_ = 0xcbf29ce484222325ull;
};

void print_tree(const std::string& what, const Tree& tree) {
    Digest digest;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        digest.add(node.position);
        digest.add(node.radius);
    }
    digest.print(what);
}

void print_meshes(const std::string& what, const Tree& tree, const LeafRules& rules) {
    for (int level = 0; level < 5; level++) {
        TubeOptions options;
        options.level = level;
        const Mesh mesh = build_branch_tubes(tree, options);
        Digest digest;
        digest.add_all(mesh.positions);
        digest.add_all(mesh.normals);
        digest.add_all(mesh.tangents);
        digest.add_all(mesh.uvs);
        digest.add_all(mesh.colors);
        digest.add_all(mesh.custom0);
        digest.add_all(mesh.radii);
        digest.add_all(mesh.indices);
        digest.print(what + " bark " + std::to_string(level));
    }
    const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, 7);
    for (int level = 0; level < 5; level++) {
        Digest digest;
        digest.add_all(leaf_buffer(thin_leaves(leaves, level)));
        const Mesh card = build_leaf_card(rules, level);
        digest.add_all(card.positions);
        digest.add_all(card.normals);
        digest.add_all(leaf_buffer(leaves_of_level(leaves, rules, level).leaves));
        digest.print(what + " leaves " + std::to_string(level));
    }
    Digest digest;
    for (const Capsule& capsule : fit_capsules(tree)) {
        digest.add(capsule.from);
        digest.add(capsule.to);
        digest.add(capsule.radius);
    }
    digest.print(what + " capsules");
}

void print_all() {
    const std::vector<std::string> looks = leaf_preset_names();
    size_t look = 0;
    for (const Habit habit : all_habits()) {
        GrowOptions grow;
        grow.habit = habit;
        grow.seed = 3;
        const Tree tree = grow_tree(grow);
        const std::string name = habit_name(habit);
        const LeafRules rules = leaf_preset(looks[look++ % looks.size()]);
        print_tree(name, tree);
        print_meshes(name, tree, rules);
        const VariantMaker maker(tree);
        for (const uint64_t seed : {1u, 2u, 3u}) {
            const Tree variant = maker.make(seed, 0.3 * static_cast<double>(seed)).tree;
            print_tree(name + " variant " + std::to_string(seed), variant);
            if (seed == 2) print_meshes(name + " variant", variant, rules);
        }
        Tree edited = tree;
        run_script(edited, "prune factor=1.5\nsmooth_paths\nlighten nodes=300\n");
        print_tree(name + " edited", edited);
    }
    for (const std::string& name : grammar_preset_names()) {
        const Grammar grammar = Grammar::parse(grammar_preset(name));
        RewriteOptions options;
        options.iterations = 4;
        const std::string text = rewrite(grammar, options);
        Digest digest;
        digest.add(text);
        digest.print("grammar " + name);
        const Tree grown = read_lstring(text, grammar.turtle);
        print_tree("grammar " + name + " tree", grown);
    }
    Random random(1);
    Digest digest;
    for (int i = 0; i < 10000; i++)
        digest.add(random.normal());
    digest.print("random numbers");
}

}  // namespace
}  // namespace treerec

int main() {
    treerec::print_all();
}
