// Stacked histograms as inline SVG. Internal to pipeline/.
#pragma once

#include <string>
#include <vector>

namespace treerec {

// values[class][bin]: amounts, drawn from the bottom up; colors: of the classes; edges: labels under the
// bins' borders, one more than bins. axis: what the bins are; unit: of the amounts.
struct Histogram {
    std::string axis;
    std::string unit;
    std::vector<std::string> edges;
    std::vector<std::vector<double>> values;
    std::vector<std::string> names;  // of the classes
};

// The colour of the class (of an order of branching).
const char* class_color(size_t c);
// Leaves out the upper bins that hold nothing, but for the first four.
void trim(Histogram& histogram);
std::string histogram_svg(const Histogram& histogram);

// A number with so many digits after the point; "-" for one that is not finite.
std::string fixed(double value, int digits);

}  // namespace treerec
