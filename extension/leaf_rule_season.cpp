// What the seasons make of a LeafRule.
#include <algorithm>
#include <cmath>

#include "leaf_rule.h"

using namespace godot;

namespace {

// Where in a year (0 buds .. 1 bare) leaves unfold, begin to fall and have fallen.
constexpr double kUnfolded = 0.2, kFirstFall = 0.72;
constexpr double kBudSize = 0.3;     // of a full leaf
constexpr double kOwnSeason = 0.07;  // how far leaves differ in what season it is for them
constexpr double kSpring = 0.05, kSummer = 0.3, kLateSummer = 0.5, kAutumn = 0.68;

const Color kSpringColor(0.55f, 0.66f, 0.30f, 0.4f);
const Color kFallenColor(0.60f, 0.46f, 0.30f, 0.85f);

// What a kind of tree turns to in autumn; alpha 0 for an evergreen.
struct AutumnColor {
    const char* look;
    Color color;
};
const AutumnColor kAutumnColors[] = {
    {"generic", Color(0.74f, 0.54f, 0.20f, 0.82f)},
    {"maple", Color(0.70f, 0.27f, 0.12f, 0.85f)},
    {"cherry", Color(0.72f, 0.37f, 0.16f, 0.82f)},
    {"oak", Color(0.60f, 0.40f, 0.18f, 0.85f)},
    {"birch", Color(0.80f, 0.65f, 0.20f, 0.85f)},
    {"willow", Color(0.72f, 0.67f, 0.26f, 0.8f)},
    {"apple", Color(0.68f, 0.56f, 0.22f, 0.8f)},
    {"ginkgo", Color(0.90f, 0.74f, 0.14f, 0.92f)},
    {"poplar", Color(0.84f, 0.68f, 0.18f, 0.85f)},
    {"magnolia", Color(0, 0, 0, 0)},
    {"pine", Color(0, 0, 0, 0)},
    {"spruce", Color(0, 0, 0, 0)},
    {"palm", Color(0, 0, 0, 0)},
};

Color autumn_color(const String& p_look) {
    for (const AutumnColor& entry : kAutumnColors) {
        if (p_look == String(entry.look)) {
            return entry.color;
        }
    }
    return kAutumnColors[0].color;
}

double smooth(double p_low, double p_high, double p_x) {
    const double t = std::clamp((p_x - p_low) / (p_high - p_low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// How large leaves are in a season, over full ones.
double unfolded_share(double p_season) {
    return kBudSize + (1.0 - kBudSize) * smooth(0.0, kUnfolded, p_season);
}

Color mixed(const Color& p_a, const Color& p_b, double p_t) {
    const float t = float(std::clamp(p_t, 0.0, 1.0));
    return Color(p_a.r + (p_b.r - p_a.r) * t, p_a.g + (p_b.g - p_a.g) * t, p_a.b + (p_b.b - p_a.b) * t,
                 p_a.a + (p_b.a - p_a.a) * t);
}

// The year of a kind of tree that brings no ramp of its own: young green, the leaves' own colour, autumn,
// brown.
Color usual_color(const String& p_look, double p_season) {
    const Color autumn = autumn_color(p_look);
    const Color spring(kSpringColor.r, kSpringColor.g, kSpringColor.b,
                       autumn.a > 0.0f ? kSpringColor.a : 0.25f);
    const Color summer(spring.r, spring.g, spring.b, 0.0f);
    const Color late(autumn.r, autumn.g, autumn.b, 0.0f);
    if (p_season < kSummer) {
        return mixed(spring, summer, (p_season - kSpring) / (kSummer - kSpring));
    }
    if (autumn.a == 0.0f || p_season < kLateSummer) {
        return p_season < 0.5 * (kSummer + kLateSummer) ? summer : late;
    }
    if (p_season < kAutumn) {
        return mixed(late, autumn, (p_season - kLateSummer) / (kAutumn - kLateSummer));
    }
    return mixed(autumn, kFallenColor, (p_season - kAutumn) / (1.0 - kAutumn));
}

}  // namespace

treerec::LeafRules LeafRule::in_season(treerec::LeafRules p_rules, bool p_evergreen) const {
    const std::lock_guard lock(mutex_);
    if (!p_evergreen) {
        p_rules.standing = 1.0 - smooth(kFirstFall, 1.0, season_);
        p_rules.unfolded = unfolded_share(season_);
    }
    return p_rules;
}

PackedColorArray LeafRule::get_tints_at(double p_shift, const String& p_look) const {
    PackedColorArray tints;
    const bool own = p_look.is_empty() || p_look == look_;
    const double middle = std::clamp(season_ + p_shift, 0.0, 1.0);
    for (const double season : {middle - kOwnSeason, middle + kOwnSeason}) {
        const double at = std::clamp(season, 0.0, 1.0);
        const Color usual = usual_color(own ? look_ : p_look, at);
        const Color tint = own && season_colors_.is_valid() ? season_colors_->sample(float(at)) : usual;
        // A ramp may hold colours that are none.
        const bool finite =
            std::isfinite(tint.r) && std::isfinite(tint.g) && std::isfinite(tint.b) && std::isfinite(tint.a);
        tints.push_back(finite ? tint : usual);
    }
    return tints;
}

Vector2 LeafRule::get_shares_at(double p_shift, bool p_evergreen) const {
    const double season = std::clamp(season_ + p_shift, 0.0, 1.0);
    return p_evergreen ? Vector2(1.0f, 1.0f)
                       : Vector2(float(1.0 - smooth(kFirstFall, 1.0, season)), float(unfolded_share(season)));
}

bool LeafRule::is_look_evergreen(const String& p_look) {
    return autumn_color(p_look).a == 0.0f;
}

void LeafRule::set_season(double p_season) {
    ERR_FAIL_COND_MSG(!std::isfinite(p_season), "season must be a finite number.");
    const double season = std::clamp(p_season, 0.0, 1.0);
    // What animates it may set the same again and again.
    if (season != season_) {
        _change([&] { season_ = season; });
    }
}

void LeafRule::set_evergreen(bool p_evergreen) {
    _change([&] { evergreen_ = p_evergreen; });
}

PackedColorArray LeafRule::get_season_tints() const {
    return get_tints_at(0.0);
}

double LeafRule::get_standing_share() const {
    return get_rules().standing;
}

double LeafRule::get_unfolded_share() const {
    const std::lock_guard lock(mutex_);
    return evergreen_ ? 1.0 : unfolded_share(season_);
}
