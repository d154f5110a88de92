#include "textures/bark_kinds.h"

namespace treerec::bark {

namespace {

// Of dry bark in overcast light; what is deep gets its darkness from occlusion.
Palette palette_of(const std::string& preset) {
    if (preset == "oak")
        return {{0.28, 0.235, 0.195}, {0.385, 0.335, 0.28}, {0.495, 0.46, 0.41}, {0.435, 0.34, 0.255}};
    if (preset == "maple")
        return {{0.30, 0.26, 0.215}, {0.42, 0.38, 0.33}, {0.535, 0.505, 0.46}, {0.49, 0.42, 0.34}};
    if (preset == "cherry")
        return {{0.25, 0.19, 0.165}, {0.39, 0.275, 0.23}, {0.53, 0.405, 0.35}, {0.45, 0.36, 0.33}};
    if (preset == "pine")
        return {{0.29, 0.22, 0.18}, {0.455, 0.345, 0.275}, {0.585, 0.51, 0.46}, {0.615, 0.43, 0.315}};
    if (preset == "willow")
        return {{0.28, 0.245, 0.2}, {0.40, 0.355, 0.285}, {0.52, 0.485, 0.41}, {0.445, 0.375, 0.27}};
    if (preset == "apple")
        return {{0.30, 0.25, 0.215}, {0.46, 0.405, 0.36}, {0.58, 0.545, 0.50}, {0.54, 0.43, 0.35}};
    if (preset == "spruce")
        return {{0.28, 0.215, 0.18}, {0.43, 0.345, 0.295}, {0.56, 0.49, 0.435}, {0.53, 0.38, 0.30}};
    if (preset == "ginkgo")
        return {{0.28, 0.24, 0.205}, {0.42, 0.38, 0.335}, {0.565, 0.53, 0.485}, {0.48, 0.405, 0.33}};
    if (preset == "poplar")
        return {{0.265, 0.24, 0.205}, {0.375, 0.355, 0.305}, {0.50, 0.485, 0.435}, {0.41, 0.375, 0.295}};
    if (preset == "palm")
        return {{0.30, 0.25, 0.20}, {0.50, 0.435, 0.355}, {0.63, 0.575, 0.50}, {0.56, 0.47, 0.37}};
    if (preset == "magnolia")
        return {{0.34, 0.32, 0.295}, {0.455, 0.44, 0.41}, {0.585, 0.57, 0.54}, {0.53, 0.495, 0.435}};
    return {{0.28, 0.235, 0.197}, {0.395, 0.345, 0.29}, {0.50, 0.455, 0.395}, {0.445, 0.365, 0.285}};
}

constexpr Skin kFineSkin{{0.0015, 0.0012}, {0.006, 0.0028}, {0.013, 0.014}, 0.55, 0.0006, 0.5, 0.2, 0.35};

}  // namespace

BarkPoint old_bark(const std::string& preset, const Place& place) {
    const Palette palette = palette_of(preset);
    if (preset == "birch") return birch(place, false);
    if (preset == "palm") return ringed(place, palette);
    if (preset == "magnolia") return pimpled(place, palette);
    if (preset == "cherry")
        return smooth(place, {{0.010, 0.0030}, {0.080, 0.0095}, {0.050, 0.022}, 0.85, 0.0024, 0.0, 1.0, 0.75},
                      palette, {0.60, 0.50, 0.41});
    if (preset == "pine") return plated(place, {{0.062, 0.105}, 0.011, 0.012, 0.0011}, palette);
    if (preset == "spruce") return scaly(place, {{0.026, 0.030}, 0.0022, 0.8}, palette);
    if (preset == "apple") return scaly(place, {{0.038, 0.055}, 0.0024, 0.5}, palette);
    if (preset == "maple") return ridged(place, {0.030, 0.16, 0.0065, 0.0075, 0.25, 0.0007}, palette);
    if (preset == "ginkgo") return ridged(place, {0.045, 0.24, 0.014, 0.013, 0.15, 0.0016}, palette);
    if (preset == "willow") return ridged(place, {0.048, 0.26, 0.017, 0.015, 0.3, 0.0014}, palette);
    if (preset == "poplar") return ridged(place, {0.055, 0.30, 0.018, 0.016, 0.5, 0.0010}, palette);
    if (preset == "oak") return ridged(place, {0.046, 0.21, 0.016, 0.014, 0.65, 0.0012}, palette);
    return ridged(place, {0.036, 0.17, 0.011, 0.010, 0.45, 0.0010}, palette);
}

BarkPoint young_bark(const std::string& preset, const Place& place) {
    Palette palette = palette_of(preset);
    Skin skin = kFineSkin;
    if (preset == "birch") return birch(place, true);
    if (preset == "palm") return ringed(place, palette);
    if (preset == "spruce") return scaly(place, {{0.009, 0.010}, 0.0007, 0.6}, palette);
    if (preset == "pine") {
        // What the fox-coloured upper stem peels off is thin as paper.
        palette = {{0.36, 0.235, 0.165}, {0.55, 0.38, 0.27}, {0.66, 0.50, 0.38}, {0.62, 0.41, 0.27}};
        return scaly(place, {{0.030, 0.024}, 0.0006, 0.5}, palette);
    }
    if (preset == "cherry") {
        skin = {{0.003, 0.001}, {0.020, 0.003}, {0.020, 0.010}, 0.7, 0.0008, 0.1, 0.9, 0.9};
        palette.side = {0.39, 0.265, 0.215}, palette.crest = {0.53, 0.40, 0.34};
        return smooth(place, skin, palette, {0.60, 0.48, 0.38});
    }
    if (preset == "poplar" || preset == "willow") {
        palette = {{0.29, 0.26, 0.205}, {0.475, 0.465, 0.39}, {0.62, 0.61, 0.54}, {0.47, 0.475, 0.365}};
        if (preset == "willow") palette.side = {0.46, 0.43, 0.33}, palette.crest = {0.58, 0.55, 0.43};
        skin = {{0.003, 0.004}, {0.012, 0.013}, {0.024, 0.026}, 0.6, -0.0012, 0.35, 0.15, 0.3};
        return smooth(place, skin, palette, {0.30, 0.265, 0.215});
    }
    if (preset == "magnolia") return pimpled(place, palette);
    // A skin is greyer and lighter than the bark that bursts through it.
    palette.side = glm::mix(palette.side, DVec3(0.43, 0.415, 0.37), 0.55);
    palette.crest = glm::mix(palette.crest, DVec3(0.55, 0.54, 0.495), 0.5);
    palette.accent = glm::mix(palette.accent, DVec3(0.42, 0.42, 0.34), 0.65);
    if (preset == "maple") skin.stretch = 0.8, skin.lip = 0.0004;
    if (preset == "oak") skin.stretch = 0.6;
    if (preset == "ginkgo") skin.stretch = 1.0;
    return smooth(place, skin, palette, {0.58, 0.535, 0.465});
}

}  // namespace treerec::bark
