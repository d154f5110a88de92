#include "sketch/svg_path.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\f";
constexpr double kDegree = kPi / 180.0;

void skip_blanks(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
}

void skip_comma(std::string_view& text) {
    skip_blanks(text);
    if (!text.starts_with(',')) return;
    text.remove_prefix(1);
    skip_blanks(text);
}

// An arc's flag may stand without anything behind it: "a1 1 0 01.5.5".
std::optional<bool> take_flag(std::string_view& text) {
    skip_blanks(text);
    if (!text.starts_with('0') && !text.starts_with('1')) return {};
    const bool flag = text.front() == '1';
    text.remove_prefix(1);
    skip_comma(text);
    return flag;
}

std::optional<Affine> transform_of(std::string_view name, const std::vector<double>& by) {
    const size_t count = by.size();
    if (name == "matrix" && count == 6) return Affine{by[0], by[1], by[2], by[3], by[4], by[5]};
    if (name == "translate" && (count == 1 || count == 2))
        return Affine{1.0, 0.0, 0.0, 1.0, by[0], count == 2 ? by[1] : 0.0};
    if (name == "scale" && (count == 1 || count == 2))
        return Affine{by[0], 0.0, 0.0, count == 2 ? by[1] : by[0], 0.0, 0.0};
    if (name == "rotate" && (count == 1 || count == 3)) {
        const SineCosine turn = portable_sine_cosine(by[0] * kDegree);
        const Affine rotation{turn.cosine, turn.sine, -turn.sine, turn.cosine, 0.0, 0.0};
        if (count == 1) return rotation;
        return Affine{1.0, 0.0, 0.0, 1.0, by[1], by[2]} * rotation *
               Affine{1.0, 0.0, 0.0, 1.0, -by[1], -by[2]};
    }
    if (name == "skewX" && count == 1) return Affine{1.0, 0.0, portable::tan(by[0] * kDegree), 1.0, 0.0, 0.0};
    if (name == "skewY" && count == 1) return Affine{1.0, portable::tan(by[0] * kDegree), 0.0, 1.0, 0.0, 0.0};
    return {};
}

}  // namespace

Affine Affine::operator*(const Affine& inner) const {
    return {a * inner.a + c * inner.b, b * inner.a + d * inner.b,     a * inner.c + c * inner.d,
            b * inner.c + d * inner.d, a * inner.e + c * inner.f + e, b * inner.e + d * inner.f + f};
}

std::optional<double> take_svg_number(std::string_view& text) {
    std::string_view rest = text;
    skip_blanks(rest);
    const bool plus = rest.starts_with('+');
    if (plus) rest.remove_prefix(1);
    // from_chars() also takes words such as inf.
    const size_t first = !plus && rest.starts_with('-') ? 1 : 0;
    if (rest.size() <= first || !((rest[first] >= '0' && rest[first] <= '9') || rest[first] == '.'))
        return {};
    double value = 0.0;
    const auto [end, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (failure != std::errc()) return {};
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    skip_comma(rest);
    text = rest;
    return value;
}

std::optional<std::vector<double>> parse_svg_numbers(std::string_view text) {
    std::vector<double> numbers;
    while (const std::optional<double> number = take_svg_number(text))
        numbers.push_back(*number);
    skip_blanks(text);
    if (!text.empty()) return {};
    return numbers;
}

std::optional<Affine> parse_svg_transform(std::string_view text) {
    Affine all;
    skip_blanks(text);
    if (text == "none") return all;
    while (!text.empty()) {
        const size_t open = text.find('('), close = text.find(')');
        if (close == std::string_view::npos || open > close) return {};
        const std::string_view name = text.substr(0, std::min(text.find_first_of(" \t\r\n("), open));
        const std::optional<std::vector<double>> by =
            parse_svg_numbers(text.substr(open + 1, close - open - 1));
        const std::optional<Affine> one = by ? transform_of(name, *by) : std::nullopt;
        if (!one) return {};
        all = all * *one;
        text.remove_prefix(close + 1);
        skip_comma(text);
    }
    return all;
}

// Reads path data into lines.
class SvgPath {
  public:
    SvgPath(std::string_view data, SvgLines& lines) : rest_(data), lines_(lines) {}

    // Gives what is left where it is damaged.
    std::string_view read() {
        while (!lines_.full()) {
            skip_blanks(rest_);
            if (rest_.empty()) break;
            const std::string_view before = rest_;
            const char c = rest_.front();
            if (std::string_view("MmZzLlHhVvCcSsQqTtAa").find(c) != std::string_view::npos) {
                rest_.remove_prefix(1);
                command_ = c;
                fresh_ = true;
            }
            if (!run()) return before;
            fresh_ = false;
        }
        return lines_.full() ? std::string_view() : rest_;
    }

  private:
    // One command with its numbers.
    bool run() {
        const char upper = command_ >= 'a' ? static_cast<char>(command_ - 'a' + 'A') : command_;
        // A path begins with a place to begin from, and after the end of a part nothing but a command is
        // sound.
        if (command_ == 0 || (upper != 'M' && !begun_) || (upper == 'Z' && !fresh_)) return false;
        const DVec2 from = lines_.at_;
        DVec2 control = from;
        bool cubic = false, quadratic = false;
        if (upper == 'Z') {
            lines_.close();
        } else if (upper == 'H' || upper == 'V') {
            const std::optional<double> number = take_svg_number(rest_);
            if (!number) return false;
            DVec2 to = from;
            double& moved = upper == 'H' ? to.x : to.y;
            moved = is_relative() ? moved + *number : *number;
            lines_.line_to(to);
        } else if (upper == 'A') {
            if (!run_arc()) return false;
        } else {
            const size_t count = upper == 'C' ? 3 : upper == 'S' || upper == 'Q' ? 2 : 1;
            std::array<DVec2, 3> p{};
            for (size_t i = 0; i < count; i++) {
                const std::optional<DVec2> place = take_place();
                if (!place) return false;
                p[i] = *place;
            }
            cubic = upper == 'C' || upper == 'S';
            quadratic = upper == 'Q' || upper == 'T';
            if (upper == 'M' && fresh_) {
                lines_.move_to(p[0]);
                begun_ = true;
            } else if (upper == 'M' || upper == 'L') {
                lines_.line_to(p[0]);
            } else if (upper == 'C') {
                control = p[1];
                lines_.cubic_to(p[0], p[1], p[2]);
            } else if (upper == 'S') {
                control = p[0];
                lines_.cubic_to(after_cubic_ ? 2.0 * from - control_ : from, p[0], p[1]);
            } else {
                control = upper == 'Q' ? p[0] : after_quadratic_ ? 2.0 * from - control_ : from;
                lines_.quadratic_to(control, p[upper == 'Q' ? 1 : 0]);
            }
        }
        control_ = control;
        after_cubic_ = cubic;
        after_quadratic_ = quadratic;
        return true;
    }

    bool run_arc() {
        const std::optional<double> x = take_svg_number(rest_), y = x ? take_svg_number(rest_) : x;
        const std::optional<double> degrees = y ? take_svg_number(rest_) : y;
        const std::optional<bool> large = degrees ? take_flag(rest_) : std::nullopt;
        const std::optional<bool> sweep = large ? take_flag(rest_) : std::nullopt;
        const std::optional<DVec2> to = sweep ? take_place() : std::nullopt;
        if (!to) return false;
        lines_.arc_to({*x, *y}, *degrees, *large, *sweep, *to);
        return true;
    }

    std::optional<DVec2> take_place() {
        const std::optional<double> x = take_svg_number(rest_), y = x ? take_svg_number(rest_) : x;
        if (!y) return {};
        return is_relative() ? lines_.at_ + DVec2(*x, *y) : DVec2(*x, *y);
    }

    bool is_relative() const { return command_ >= 'a'; }

    std::string_view rest_;
    SvgLines& lines_;
    char command_ = 0;
    bool fresh_ = false;  // the numbers are the first behind their letter
    bool begun_ = false;
    bool after_cubic_ = false, after_quadratic_ = false;
    DVec2 control_{0.0};
};

size_t SvgLines::add_path(std::string_view data) {
    at_ = start_ = DVec2(0.0);
    const std::string_view left = SvgPath(data, *this).read();
    finish();
    return data.size() - left.size();
}

void SvgLines::add_polyline(const std::vector<DVec2>& points, bool closed) {
    if (points.empty()) return;
    move_to(points.front());
    for (size_t i = 1; i < points.size() && !full(); i++)
        line_to(points[i]);
    if (closed) close();
    finish();
}

void SvgLines::add_ellipse(const DVec2& centre, const DVec2& radii) {
    const DVec2 right(centre.x + radii.x, centre.y), left(centre.x - radii.x, centre.y);
    move_to(right);
    arc_to(radii, 0.0, false, true, left);
    arc_to(radii, 0.0, false, true, right);
    close();
    finish();
}

std::vector<std::vector<DVec2>> SvgLines::take() {
    return std::move(lines_);
}

void SvgLines::move_to(const DVec2& p) {
    finish();
    at_ = start_ = p;
}

void SvgLines::line_to(const DVec2& p) {
    push(to_canvas_(p));
    at_ = p;
}

// A curve of n equal steps of its parameter is within max|B''| / (8 n^2) of its lines; B'' of a quadratic
// Bezier curve is 2 (p0 - 2 p1 + p2), that of a cubic one lies between 6 times such at both ends.
void SvgLines::quadratic_to(const DVec2& control, const DVec2& p) {
    cubic_to(at_ + (control - at_) * (2.0 / 3.0), p + (control - p) * (2.0 / 3.0), p);
}

void SvgLines::cubic_to(const DVec2& first, const DVec2& second, const DVec2& p) {
    constexpr double kMostSteps = 10000.0;
    const DVec2 p0 = to_canvas_(at_), p1 = to_canvas_(first), p2 = to_canvas_(second), p3 = to_canvas_(p);
    const double bend = 6.0 * std::max(glm::length(p0 - 2.0 * p1 + p2), glm::length(p1 - 2.0 * p2 + p3));
    const double wanted = std::sqrt(bend / (8.0 * tolerance_));
    // Also where it is no number.
    const int steps = wanted < kMostSteps ? std::max(1, static_cast<int>(std::ceil(wanted))) : 10000;
    for (int i = 1; i < steps && !full(); i++) {
        const double t = static_cast<double>(i) / steps, s = 1.0 - t;
        push(s * s * s * p0 + 3.0 * s * s * t * p1 + 3.0 * s * t * t * p2 + t * t * t * p3);
    }
    push(p3);
    at_ = p;
}

// SVG 1.1, F.6.5 and F.6.6: the centre from the ends; then a cubic for each eighth of a turn or less, which
// is within 5e-6 radii of the arc.
void SvgLines::arc_to(DVec2 radii, double degrees, bool large, bool sweep, const DVec2& p) {
    radii = glm::abs(radii);
    if (at_ == p) return;
    if (!(radii.x > 0.0) || !(radii.y > 0.0)) {
        line_to(p);
        return;
    }
    const SineCosine turn = portable_sine_cosine(degrees * kDegree);
    const auto turned = [&](const DVec2& v) {
        return DVec2(turn.cosine * v.x - turn.sine * v.y, turn.sine * v.x + turn.cosine * v.y);
    };
    // From here on the ellipse is the unit circle about `centre`.
    const DVec2 half = 0.5 * (at_ - p);
    DVec2 half_unit =
        DVec2(turn.cosine * half.x + turn.sine * half.y, turn.cosine * half.y - turn.sine * half.x) / radii;
    const double square = glm::dot(half_unit, half_unit);
    if (square > 1.0) {
        radii *= std::sqrt(square);
        half_unit /= std::sqrt(square);
    }
    const double rest = std::max(0.0, 1.0 - std::min(1.0, square));
    const double away = (large == sweep ? -1.0 : 1.0) * std::sqrt(square > 0.0 ? rest / square : 0.0);
    const DVec2 centre(away * half_unit.y, -away * half_unit.x);
    const DVec2 from = half_unit - centre, to = -half_unit - centre;
    const double start = portable::atan2(from.y, from.x);
    double angle = portable::atan2(to.y, to.x) - start;
    if (sweep && angle < 0.0) angle += 2.0 * kPi;
    if (!sweep && angle > 0.0) angle -= 2.0 * kPi;
    const DVec2 middle = 0.5 * (at_ + p) + turned(centre * radii);
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / (0.25 * kPi) - 1e-9)));
    const double step = angle / pieces, reach = 4.0 / 3.0 * portable::tan(0.25 * step);
    const auto place = [&](const DVec2& unit) { return middle + turned(unit * radii); };
    SineCosine here = portable_sine_cosine(start);
    for (int i = 1; i <= pieces; i++) {
        const SineCosine next = portable_sine_cosine(start + step * i);
        const DVec2 a(here.cosine, here.sine), b(next.cosine, next.sine);
        cubic_to(place(a + reach * DVec2(-a.y, a.x)), place(b - reach * DVec2(-b.y, b.x)),
                 i == pieces ? p : place(b));
        here = next;
    }
}

void SvgLines::close() {
    if (!line_.empty() && at_ != start_) line_to(start_);
    finish();
    at_ = start_;
}

void SvgLines::finish() {
    if (line_.size() > 1) lines_.push_back(std::move(line_));
    line_.clear();
}

// The line begins where its first piece does, so that moves without lines leave nothing.
void SvgLines::push(const DVec2& on_canvas) {
    if (line_.empty()) {
        line_.push_back(to_canvas_(at_));
        count_++;
    }
    line_.push_back(on_canvas);
    count_++;
}

}  // namespace treerec
