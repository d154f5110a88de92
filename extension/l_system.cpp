#include "l_system.h"

#include <algorithm>
#include <utility>

#include "convert.h"
#include "edit/graft/scion.h"
#include "error.h"

using namespace godot;

namespace {

// The leaves of a string count as those that a scan saw.
Ref<TreeReconstruction> to_resource(treerec::LStringTree p_read, const Dictionary& p_provenance) {
    Ref<TreeReconstruction> made;
    made.instantiate();
    made->set_tree(std::move(p_read.tree));
    if (!p_read.leaves.empty()) {
        std::vector<treerec::Vec3> places;
        places.reserve(p_read.leaves.size());
        for (const treerec::LStringLeaf& leaf : p_read.leaves) {
            places.push_back(treerec::Vec3(leaf.position));
        }
        made->set_leaf_density(treerec::gather_foliage(places, {}));
    }
    made->set_provenance(p_provenance);
    return made;
}

// A tree may have so many nodes: more than a game draws.
constexpr size_t kMostNodes = 1'000'000;

}  // namespace

class LSystem::Work : public treerec::Progress {
  public:
    explicit Work(const LSystem& p_system) : system_(p_system), began_(p_system.cancels_) {}
    bool cancelled() const override { return system_.cancels_ != began_; }

  private:
    const LSystem& system_;
    const uint64_t began_;
};

LSystem::Settings LSystem::_get_settings() const {
    const std::lock_guard lock(mutex_);
    return settings_;
}

void LSystem::set_grammar(const String& p_grammar) {
    {
        const std::lock_guard lock(mutex_);
        settings_.grammar = to_std(p_grammar);
    }
    emit_changed();
}

String LSystem::get_grammar() const {
    return to_godot(_get_settings().grammar);
}

void LSystem::set_iterations(int p_iterations) {
    {
        const std::lock_guard lock(mutex_);
        settings_.rewriting.iterations = std::clamp(p_iterations, int(OWN), 10000);
    }
    emit_changed();
}

int LSystem::get_iterations() const {
    return _get_settings().rewriting.iterations;
}

void LSystem::set_maximum_symbols(int64_t p_count) {
    {
        const std::lock_guard lock(mutex_);
        settings_.rewriting.most_symbols = size_t(std::clamp<int64_t>(p_count, 1, 100'000'000));
    }
    emit_changed();
}

int64_t LSystem::get_maximum_symbols() const {
    return int64_t(_get_settings().rewriting.most_symbols);
}

void LSystem::set_maximum_seconds(double p_seconds) {
    {
        const std::lock_guard lock(mutex_);
        // Not std::clamp, which keeps what is no number.
        settings_.rewriting.most_seconds = std::max(0.01, std::min(3600.0, p_seconds));
    }
    emit_changed();
}

double LSystem::get_maximum_seconds() const {
    return _get_settings().rewriting.most_seconds;
}

std::string LSystem::_rewrite(const Settings& p_settings, const treerec::Grammar& p_grammar, int64_t p_seed,
                              Work& p_work) {
    treerec::RewriteOptions options = p_settings.rewriting;
    options.seed = p_seed == OWN ? p_grammar.seed : uint64_t(p_seed);
    return treerec::rewrite(p_grammar, options, &p_work);
}

String LSystem::generate(int64_t p_seed) const {
    return guarded(String(), [&] {
        const Settings settings = _get_settings();
        Work work(*this);
        return to_godot(_rewrite(settings, treerec::Grammar::parse(settings.grammar), p_seed, work));
    });
}

Ref<TreeReconstruction> LSystem::grow(int64_t p_seed) const {
    return guarded(Ref<TreeReconstruction>(), [&] {
        const Settings settings = _get_settings();
        treerec::Grammar grammar = treerec::Grammar::parse(settings.grammar);
        grammar.turtle.most_nodes = kMostNodes;
        Work work(*this);
        const int64_t seed = p_seed == OWN ? int64_t(grammar.seed) : p_seed;
        Dictionary provenance;
        provenance["source"] = "L-system";
        provenance["seed"] = seed;
        treerec::LStringTree read = treerec::read_lstring_with_leaves(
            _rewrite(settings, grammar, p_seed, work), grammar.turtle, &work);
        const int steps =
            settings.rewriting.iterations >= 0 ? settings.rewriting.iterations : grammar.iterations;
        treerec::require_wood(read.tree,
                              "The string that the grammar makes in " + std::to_string(steps) + " steps");
        Ref<TreeReconstruction> made = to_resource(std::move(read), provenance);
        made->set_seed(seed);
        if (!grammar.leaf_preset.empty()) {
            made->set_leaf_preset(to_godot(grammar.leaf_preset));
        }
        return made;
    });
}

void LSystem::cancel() {
    cancels_++;
}

String LSystem::get_error_message() const {
    try {
        treerec::Grammar::parse(_get_settings().grammar);
        return String();
    } catch (const treerec::Error& error) {
        return to_godot(std::string(error.what()));
    }
}

PackedStringArray LSystem::get_preset_names() {
    PackedStringArray names;
    for (const std::string& name : treerec::grammar_preset_names()) {
        names.push_back(to_godot(name));
    }
    return names;
}

String LSystem::get_preset(const String& p_name) {
    return guarded(String(), [&] { return to_godot(treerec::grammar_preset(to_std(p_name))); });
}

Ref<TreeReconstruction> LSystem::read_string(const String& p_text, Dialect p_dialect, double p_angle_spread,
                                             double p_length_spread, int64_t p_seed) {
    return guarded(Ref<TreeReconstruction>(), [&] {
        Dictionary provenance;
        provenance["source"] = "L-string";
        treerec::LStringOptions options = read_options(p_dialect);
        if (!(p_angle_spread >= 0.0 && p_angle_spread <= 180.0 && p_length_spread >= 0.0 &&
              p_length_spread <= 1.0)) {
            throw treerec::Error(
                "A string's angles vary by 0 to 180 degrees, its lengths by a share of 0 to 1.");
        }
        options.angle_spread = p_angle_spread;
        options.length_spread = p_length_spread;
        options.seed = uint64_t(p_seed);
        treerec::LStringTree read = treerec::read_lstring_with_leaves(to_std(p_text), options);
        treerec::require_wood(read.tree, "The L-string");
        if (p_angle_spread > 0.0 || p_length_spread > 0.0) {
            provenance["seed"] = p_seed;
        }
        return to_resource(std::move(read), provenance);
    });
}

treerec::LStringOptions LSystem::read_options(Dialect p_dialect) {
    if (p_dialect < DIALECT_TURTLE || p_dialect > DIALECT_TOLD) {
        throw treerec::Error("There is no dialect " + std::to_string(int(p_dialect)) + " of L-strings.");
    }
    treerec::LStringOptions options;
    options.dialect_is_told = p_dialect != DIALECT_TOLD;
    options.dialect =
        p_dialect == DIALECT_PAPER ? treerec::LStringDialect::kPaper : treerec::LStringDialect::kTurtle;
    return options;
}

String LSystem::write_string(const Ref<TreeReconstruction>& p_tree, int64_t p_node, Dialect p_dialect) {
    return guarded(String(), [&] {
        if (p_tree.is_null()) {
            throw treerec::Error("There is no tree to write as a string.");
        }
        const std::shared_ptr<const treerec::Tree> tree = p_tree->get_tree();
        if (tree->empty()) {
            throw treerec::Error("The tree is empty; there is nothing to write as a string.");
        }
        // The heading says which dialect it is, wherever the string goes.
        const treerec::LStringOptions options = read_options(p_dialect);
        const std::string heading = treerec::heading(options);
        if (p_node == TreeReconstruction::NO_NODE || p_node == tree->root()) {
            return to_godot(heading + treerec::write_lstring(*tree, tree->root(), options));
        }
        const treerec::Tree scion = treerec::take_scion(*tree, node_of(*tree, p_node));
        return to_godot(heading + treerec::write_lstring(scion, scion.root(), options));
    });
}

void LSystem::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_grammar", "grammar"), &LSystem::set_grammar);
    ClassDB::bind_method(D_METHOD("get_grammar"), &LSystem::get_grammar);
    ClassDB::bind_method(D_METHOD("set_iterations", "iterations"), &LSystem::set_iterations);
    ClassDB::bind_method(D_METHOD("get_iterations"), &LSystem::get_iterations);
    ClassDB::bind_method(D_METHOD("set_maximum_symbols", "count"), &LSystem::set_maximum_symbols);
    ClassDB::bind_method(D_METHOD("get_maximum_symbols"), &LSystem::get_maximum_symbols);
    ClassDB::bind_method(D_METHOD("set_maximum_seconds", "seconds"), &LSystem::set_maximum_seconds);
    ClassDB::bind_method(D_METHOD("get_maximum_seconds"), &LSystem::get_maximum_seconds);
    ClassDB::bind_method(D_METHOD("generate", "seed"), &LSystem::generate, DEFVAL(int(OWN)));
    ClassDB::bind_method(D_METHOD("grow", "seed"), &LSystem::grow, DEFVAL(int(OWN)));
    ClassDB::bind_method(D_METHOD("cancel"), &LSystem::cancel);
    ClassDB::bind_method(D_METHOD("get_error_message"), &LSystem::get_error_message);
    ClassDB::bind_static_method("LSystem", D_METHOD("get_preset_names"), &LSystem::get_preset_names);
    ClassDB::bind_static_method("LSystem", D_METHOD("get_preset", "name"), &LSystem::get_preset);
    ClassDB::bind_static_method(
        "LSystem", D_METHOD("read_string", "text", "dialect", "angle_spread", "length_spread", "seed"),
        &LSystem::read_string, DEFVAL(int(DIALECT_TOLD)), DEFVAL(0.0), DEFVAL(0.0), DEFVAL(1));
    ClassDB::bind_static_method("LSystem", D_METHOD("write_string", "tree", "node", "dialect"),
                                &LSystem::write_string, DEFVAL(int(TreeReconstruction::NO_NODE)),
                                DEFVAL(int(DIALECT_TURTLE)));

    ADD_PROPERTY(PropertyInfo(Variant::STRING, "grammar", PROPERTY_HINT_MULTILINE_TEXT), "set_grammar",
                 "get_grammar");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "iterations", PROPERTY_HINT_RANGE, "-1,20,1,or_greater"),
                 "set_iterations", "get_iterations");
    ADD_PROPERTY(
        PropertyInfo(Variant::INT, "maximum_symbols", PROPERTY_HINT_RANGE, "1000,10000000,1000,or_greater"),
        "set_maximum_symbols", "get_maximum_symbols");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "maximum_seconds", PROPERTY_HINT_RANGE, "0.1,60,0.1,suffix:s"),
                 "set_maximum_seconds", "get_maximum_seconds");

    BIND_ENUM_CONSTANT(DIALECT_TURTLE);
    BIND_ENUM_CONSTANT(DIALECT_PAPER);
    BIND_ENUM_CONSTANT(DIALECT_TOLD);
    BIND_CONSTANT(OWN);
}
