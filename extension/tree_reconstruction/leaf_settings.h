// What the leaves of wood without a rule of its own are like.
#pragma once

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/variant/string.hpp>
#include <mutex>

#include "foliage/leaf_rules.h"
#include "leaf_rule.h"

// As a value.
struct LeafSetting {
    treerec::LeafRules rules;  // where there is no rule
    godot::Ref<LeafRule> rule;
    godot::String preset = "generic";
    bool foliage_followed = true;
    int64_t seed = 1;
};

// Any thread may read it while another changes it.
class LeafSettings {
  public:
    // One of the numbers of LeafSetting::rules that the inspector shows.
    struct Value {
        const char* property;
        double treerec::LeafRules::*member;
        double minimum;
        double maximum;
        const char* hint;  // range, step and unit for the inspector
    };
    static const Value kValues[8];

    LeafSetting get() const {
        const std::lock_guard lock(mutex_);
        return setting_;
    }
    // change(setting)
    template <typename Change>
    void change(const Change& p_change) {
        const std::lock_guard lock(mutex_);
        p_change(setting_);
    }
    // Those of the rule, if there is one.
    treerec::LeafRules get_rules() const;
    // The name of the textures.
    godot::String get_look() const;

  private:
    mutable std::mutex mutex_;
    LeafSetting setting_;
};
