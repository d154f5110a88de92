// One scanner station's view of the surfaces. Internal to synth/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/random.h"
#include "synth/surfaces.h"

namespace treerec {

// The beam's diameter: at the scanner, and how much it grows per metre. Metres.
struct Beam {
    double exit = 0.0;
    double divergence = 0.0;

    double radius(double range) const { return 0.5 * (exit + divergence * range); }
};

struct ScanReturn {
    DVec3 position;
    int32_t surface;  // index; of a mixed beam, the nearer one
    bool mixed;
};

// A grid of beams in azimuth and elevation. Azimuth is measured from the direction to the tree, so that the
// view never wraps around.
class ScanView {
  public:
    // step: radians between beams. Throws Error if that makes too many beams.
    ScanView(const DVec3& eye, const DVec3& towards, double step, const Beam& beam, const Bounds& bounds);

    // Draws surface `index`. Every beam keeps the nearest surface that its middle meets and the nearest one
    // that only its rim meets.
    void draw(const Surface& surface, int32_t index);

    // Hides round patches of the view until about `share` of the returns are gone.
    void occlude(double share, Random& random);

    // Appends the returns, row by row, with range noise (standard deviation in metres, more where the beam
    // grazes); of the beams split between two surfaces, the share `mixed` reports a range between them.
    void collect(const std::vector<Surface>& surfaces, double noise, double mixed, Random& random,
                 std::vector<ScanReturn>& out) const;

  private:
    static constexpr float kNothing = std::numeric_limits<float>::max();
    struct Hit {
        float range = kNothing;
        int32_t surface = -1;
    };
    struct Cell {
        Hit middle, rim;
        bool empty() const { return middle.range == kNothing && rim.range == kNothing; }
    };

    DVec2 angles_to(const DVec3& p) const;
    DVec3 direction_of(int column, int row) const;
    size_t index(int column, int row) const {
        return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
    }
    size_t returns() const;

    DVec3 eye_, forward_, right_;
    double step_;
    Beam beam_;
    double azimuth_ = 0.0, elevation_ = 0.0;
    int columns_ = 0, rows_ = 0;
    std::vector<Cell> cells_;
};

}  // namespace treerec
