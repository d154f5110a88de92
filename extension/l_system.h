#pragma once

#include <atomic>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <mutex>
#include <string>

#include "lsystem/grammar.h"
#include "tree_reconstruction/tree_reconstruction.h"

// A grammar that grows trees, as text. generate() and grow() may run on any thread, also while another one
// changes the text.
class LSystem : public godot::Resource {
    GDCLASS(LSystem, godot::Resource)

  public:
    enum Dialect { DIALECT_TURTLE, DIALECT_PAPER, DIALECT_TOLD };
    enum { OWN = -1 };  // the grammar's own iterations or seed

    void set_grammar(const godot::String& p_grammar);
    godot::String get_grammar() const;
    void set_iterations(int p_iterations);
    int get_iterations() const;
    void set_maximum_symbols(int64_t p_count);
    int64_t get_maximum_symbols() const;
    void set_maximum_seconds(double p_seconds);
    double get_maximum_seconds() const;

    godot::String generate(int64_t p_seed) const;
    godot::Ref<TreeReconstruction> grow(int64_t p_seed) const;
    void cancel();
    godot::String get_error_message() const;

    static godot::PackedStringArray get_preset_names();
    static godot::String get_preset(const godot::String& p_name);
    static godot::Ref<TreeReconstruction> read_string(const godot::String& p_text, Dialect p_dialect,
                                                      double p_angle_spread, double p_length_spread,
                                                      int64_t p_seed);
    // How a string of that dialect is read. Throws treerec::Error for one that there is not.
    static treerec::LStringOptions read_options(Dialect p_dialect);
    static godot::String write_string(const godot::Ref<TreeReconstruction>& p_tree, int64_t p_node,
                                      Dialect p_dialect);

  protected:
    static void _bind_methods();

  private:
    struct Settings {
        std::string grammar;
        treerec::RewriteOptions rewriting;
    };
    Settings _get_settings() const;
    // Of what is under way when cancel() is called.
    class Work;
    static std::string _rewrite(const Settings& p_settings, const treerec::Grammar& p_grammar, int64_t p_seed,
                                Work& p_work);

    mutable std::mutex mutex_;
    std::atomic<uint64_t> cancels_ = 0;
    Settings settings_ = {"", {-1, 1, 1'000'000, size_t(256) << 20, 10.0}};
};

VARIANT_ENUM_CAST(LSystem::Dialect);
