#include "pipeline/histogram_svg.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kWidth = 520.0, kHeight = 240.0;
constexpr double kLeft = 46.0, kRight = 10.0, kTop = 12.0, kBottom = 40.0;

// A step of 1, 2 or 5 times a power of ten, of which about four reach `most`.
double step_for(double most) {
    const double rough = most / 4.0;
    const double power = portable::pow(10.0, std::floor(portable::log10(rough)));
    for (double factor : {1.0, 2.0, 5.0})
        if (factor * power >= rough * 0.999) return factor * power;
    return 10.0 * power;
}

std::string text(double x, double y, const char* anchor, const std::string& words) {
    return "<text x=\"" + fixed(x, 1) + "\" y=\"" + fixed(y, 1) + "\" text-anchor=\"" + anchor + "\">" +
           words + "</text>";
}

}  // namespace

const char* class_color(size_t c) {
    constexpr const char* kColors[] = {"#5b3f29", "#a5692e", "#d9a441", "#7fa650", "#3f8f83", "#7a6fae"};
    return kColors[std::min(c, std::size(kColors) - 1)];
}

std::string fixed(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    char buffer[400];
    const auto [end, failure] =
        std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::fixed, digits);
    return failure == std::errc() ? std::string(buffer, end) : "-";
}

void trim(Histogram& histogram) {
    constexpr size_t kLeastBins = 4;
    size_t bins = histogram.edges.size() - 1;
    const auto empty = [&](size_t bin) {
        return std::all_of(histogram.values.begin(), histogram.values.end(),
                           [bin](const std::vector<double>& values) { return values[bin] == 0.0; });
    };
    while (bins > kLeastBins && empty(bins - 1))
        bins--;
    histogram.edges.resize(bins + 1);
    for (std::vector<double>& values : histogram.values)
        values.resize(bins);
}

std::string histogram_svg(const Histogram& histogram) {
    const size_t bins = histogram.edges.size() - 1;
    std::vector<double> totals(bins, 0.0);
    for (const std::vector<double>& values : histogram.values)
        for (size_t i = 0; i < bins; i++)
            totals[i] += values[i];
    const double most = std::max(1e-9, *std::max_element(totals.begin(), totals.end()));
    const double step = step_for(most);
    const double top = step * std::ceil(most / step - 1e-9);
    const double inner_width = kWidth - kLeft - kRight, inner_height = kHeight - kTop - kBottom;
    const double bin = inner_width / static_cast<double>(bins), base = kHeight - kBottom;
    std::string svg = "<svg viewBox=\"0 0 520 240\" role=\"img\" aria-label=\"" + histogram.unit + " by " +
                      histogram.axis + "\">";
    const int digits = std::max(0, static_cast<int>(-std::floor(portable::log10(step) + 1e-9)));
    for (double at = 0.0; at <= top * 1.0001; at += step) {
        const double y = base - inner_height * at / top;
        svg += "<line class=\"grid\" x1=\"46\" x2=\"510\" y1=\"" + fixed(y, 1) + "\" y2=\"" + fixed(y, 1) +
               "\"/>";
        svg += text(kLeft - 6.0, y + 3.5, "end", fixed(at, digits));
    }
    for (size_t i = 0; i < bins; i++) {
        double y = base;
        for (size_t c = 0; c < histogram.values.size(); c++) {
            const double height = inner_height * histogram.values[c][i] / top;
            if (height < 0.05) continue;
            y -= height;
            svg += "<rect x=\"" + fixed(kLeft + bin * static_cast<double>(i) + 1.5, 1) + "\" y=\"" +
                   fixed(y, 2) + "\" width=\"" + fixed(bin - 3.0, 1) + "\" height=\"" + fixed(height, 2) +
                   "\" fill=\"" + class_color(c) + "\"><title>" + histogram.names[c] + ": " +
                   fixed(histogram.values[c][i], digits + 1) + "</title></rect>";
        }
    }
    for (size_t i = 0; i <= bins; i++)
        svg += text(kLeft + bin * static_cast<double>(i), base + 15.0, "middle", histogram.edges[i]);
    svg += text(kLeft + 0.5 * inner_width, kHeight - 6.0, "middle", histogram.axis);
    return svg + "</svg>";
}

}  // namespace treerec
