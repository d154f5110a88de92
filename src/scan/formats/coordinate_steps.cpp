#include "scan/formats/coordinate_steps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kFewest = 100;     // points by which rounding can be told
constexpr size_t kLookedAt = 8192;  // values of an axis, about
// Of the cloud's extent: 2 cm in a tree of 7 m.
constexpr double kCoarse = 1.0 / 400.0;
constexpr double kCoarseDigits = 1.0 / 100.0;  // where it may be how fine somebody wanted to write
// A coordinate in steps: of 32-bit numbers it has 2^23 to 2^24, of six or seven digits 10^5 to 10^7.
constexpr double kFewestDigits = 1e5;
constexpr double kMostDigits = 1e7;
constexpr double kFewestFloat = 8388608.0;
constexpr double kMostFloat = 16777216.0;
constexpr double kOnStep = 1e-3;  // of a step: so near is on it

bool is_on_step(double value, double first, double step) {
    const double steps = (value - first) / step;
    return std::abs(steps - std::round(steps)) < kOnStep;
}

bool is_float(double value) {
    return static_cast<double>(static_cast<float>(value)) == value;
}

bool is_power_of_ten(double step) {
    const double power = portable::pow(10.0, std::round(portable::log10(step)));
    return std::abs(step / power - 1.0) < 1e-6;
}

struct Axis {
    std::vector<double> values;  // sorted, each once
    double extent = 0.0;         // without the outermost fiftieths
};

Axis look_at(const std::vector<DVec3>& positions, const std::vector<uint8_t>& keep, int axis) {
    Axis result;
    const size_t stride = positions.size() / kLookedAt + 1;
    for (size_t i = 0; i < positions.size(); i += stride)
        if (keep[i]) result.values.push_back(positions[i][axis]);
    std::vector<double>& values = result.values;
    if (values.size() < kFewest) return result;
    std::sort(values.begin(), values.end());
    result.extent = values[values.size() * 49 / 50] - values[values.size() / 50];
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return result;
}

// 0 where the values come in no steps.
double step_of(const std::vector<double>& values) {
    if (values.size() < 2) return 0.0;
    double step = values[1] - values[0];
    for (size_t i = 1; i < values.size(); i++)
        step = std::min(step, values[i] - values[i - 1]);
    for (const double value : values)
        if (!is_on_step(value, values[0], step)) return 0.0;
    return step;
}

}  // namespace

std::optional<CoordinateSteps> find_coarse_steps(const std::vector<DVec3>& positions,
                                                 const std::vector<uint8_t>& keep) {
    std::array<Axis, 3> axes;
    double extent = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        axes[static_cast<size_t>(axis)] = look_at(positions, keep, axis);
        extent = std::max(extent, axes[static_cast<size_t>(axis)].extent);
    }
    std::optional<CoordinateSteps> found;
    for (int axis = 0; axis < 3; axis++) {
        const std::vector<double>& values = axes[static_cast<size_t>(axis)].values;
        const double step = step_of(values);
        if (!(step > kCoarse * extent) || (found && step <= found->step)) continue;
        const double first = values.front();
        const double in_steps = std::max(std::abs(first), std::abs(values.back())) / step;
        const bool as_floats = in_steps >= kFewestFloat && in_steps <= kMostFloat &&
                               std::all_of(values.begin(), values.end(), is_float);
        const bool as_digits = step > kCoarseDigits * extent && in_steps >= kFewestDigits &&
                               in_steps <= kMostDigits && is_power_of_ten(step);
        if (!as_floats && !as_digits) continue;
        // Not of a sample alone.
        const auto is_off = [&](size_t i) {
            return keep[i] != 0 && !is_on_step(positions[i][axis], first, step);
        };
        bool all = true;
        for (size_t i = 0; all && i < positions.size(); i++)
            all = !is_off(i);
        if (all) found = {axis, step, as_floats};
    }
    return found;
}

}  // namespace treerec
