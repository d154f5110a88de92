// The turtle of Prusinkiewicz and Lindenmayer, The Algorithmic Beauty of Plants (ABOP), 1.5 and 2.3.
#pragma once

#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/vec.h"

namespace treerec {

inline constexpr double kRadiansPerDegree = kPi / 180.0;

// A place and three perpendicular unit vectors: heading H, left L, up U, with H x L = U. A new turtle stands
// at the origin, heads along +Y and has +Z for its up. Angles in degrees. ABOP's words say which way a
// symbol turns (+ left, & down, \ roll left); its matrices R_U, R_L, R_H are those of these turns,
// transposed.
struct Turtle {
    DVec3 position{0.0};
    DVec3 heading{0.0, 1.0, 0.0};
    DVec3 left{-1.0, 0.0, 0.0};
    DVec3 up{0.0, 0.0, 1.0};

    void turn_left(double degrees) { rotate(heading, left, degrees); }
    void pitch_up(double degrees) { rotate(heading, up, degrees); }
    void roll_left(double degrees) { rotate(up, left, degrees); }
    void turn_around() {
        heading = -heading;
        left = -left;
    }
    void move(double length) { position += heading * length; }

    // ABOP's $ (2.3): rolls until L is level, `skyward` being the unit vector against gravity. Nothing for a
    // heading straight up or down.
    void level(const DVec3& skyward) {
        const DVec3 side = glm::cross(skyward, heading);
        const double length = glm::length(side);
        if (length < 1e-9) return;
        left = side / length;
        up = glm::cross(heading, left);
    }

    // Bends the heading towards `tropism` by elasticity * |H x T| radians (ABOP 2.3, figure 2.9).
    void bend(const DVec3& tropism, double elasticity) {
        const DVec3 torque = glm::cross(heading, tropism);
        const double length = glm::length(torque);
        if (length < 1e-12) return;
        const DVec3 axis = torque / length;
        const double angle = elasticity * length;
        for (DVec3* v : {&heading, &left, &up})
            *v = *v * portable::cos(angle) + glm::cross(axis, *v) * portable::sin(angle) +
                 axis * (glm::dot(axis, *v) * (1.0 - portable::cos(angle)));
    }

  private:
    // Turns `from` towards `to`, and `to` away from `from`.
    static void rotate(DVec3& from, DVec3& to, double degrees) {
        const double cosine = portable::cos(degrees * kRadiansPerDegree);
        const double sine = portable::sin(degrees * kRadiansPerDegree);
        const DVec3 turned = from * cosine + to * sine;
        to = to * cosine - from * sine;
        from = turned;
    }
};

}  // namespace treerec
