// The outlines and colours of leaves, for the pictures. Internal to textures/.
#pragma once

#include <string>

#include "geometry/vec.h"

namespace treerec::texture {

enum class Margin { kSmooth, kSerrate, kLobed };

struct Shape {
    double width;   // full width over length of one lobe
    double widest;  // where along the lobe it is widest, 0..1
    double taper;   // > 1 draws the tip out
    Margin margin;
    int teeth;       // along one side
    double depth;    // of the teeth, over the width
    int veins;       // pairs of side veins
    bool palmate;    // five lobes from one point
    double petiole;  // over the leaf's length
    bool fan =
        false;  // veins that fork from the base, a cleft in the middle: the ginkgo's; width, depth are its
};

// How the picture of a spray is drawn.
enum class Habit { kLeaves, kTuft, kFlatTwigs, kFrond, kShortShoots, kRosette };

struct Spray {
    Shape shape;
    int pairs;           // leaves beside the twig: 2 per pair
    bool opposite;       // else alternate
    double leaf_length;  // of the blade
    double spread;       // radians between the twig and its lowest leaves
    DVec3 dark, light;   // blade colours, sRGB
    DVec3 vein, twig;
    Habit habit = Habit::kLeaves;
    int side_shoots = 0;  // of kLeaves, with half as many leaves
};

// preset: a leaf preset's name; unknown ones get the generic leaf.
Spray spray_of(const std::string& preset);

// What a blade shows at a point: how far inside it is (negative: outside; in lengths), vein strength, relief.
struct BladePoint {
    double inside = -1.0;
    double vein = 0.0;
    double relief = 0.0;
};

// `s` along the midrib from the base (0) to the tip (1), `t` across, to the left; both over the blade's
// length.
BladePoint blade_at(const Shape& shape, double s, double t);

// Where the blade lies, in s and t.
struct BladeBox {
    double s_low, s_high, t_low, t_high;

    double width_over_length() const { return (t_high - t_low) / (s_high - s_low); }
};
BladeBox box_of(const Shape& shape);

}  // namespace treerec::texture
