#include "tree_reconstruction/leaf_settings.h"

using namespace godot;

const LeafSettings::Value LeafSettings::kValues[] = {
    {"leaf_internode", &treerec::LeafRules::internode, 0.005, 5.0, "0.005,1,0.005,or_greater,suffix:m"},
    {"leaf_twig_length", &treerec::LeafRules::twig_length, 0.0, 100.0, "0,5,0.01,or_greater,suffix:m"},
    {"leaf_maximum_radius", &treerec::LeafRules::maximum_radius, 0.0, 10.0,
     "0,0.2,0.001,or_greater,suffix:m"},
    {"leaf_size", &treerec::LeafRules::leaf_size, 0.005, 10.0, "0.01,1,0.005,or_greater,suffix:m"},
    {"leaf_size_variation", &treerec::LeafRules::size_variation, 0.0, 1.0, "0,1,0.01"},
    {"leaf_angle", &treerec::LeafRules::angle, 0.0, 180.0, "0,180,1,suffix:°"},
    {"leaf_droop", &treerec::LeafRules::droop, -180.0, 180.0, "-90,90,1,suffix:°"},
    {"leaf_angle_variation", &treerec::LeafRules::angle_variation, 0.0, 180.0, "0,90,1,suffix:°"},
};

treerec::LeafRules LeafSettings::get_rules() const {
    LeafSetting setting = get();
    if (setting.rule.is_valid()) {
        return setting.rule->get_rules();
    }
    if (!setting.foliage_followed) {
        setting.rules.follow_density = 0.0;
        setting.rules.follow_color = 0.0;
    }
    return setting.rules;
}

String LeafSettings::get_look() const {
    const LeafSetting setting = get();
    if (setting.rule.is_valid()) {
        return setting.rule->get_look();
    }
    return setting.preset == String("none") ? String("generic") : setting.preset;
}
