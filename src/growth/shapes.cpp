#include "growth/shapes.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "edit/command_text.h"
#include "file_bytes.h"
#include "geometry/portable_math.h"

namespace treerec::growth {

namespace {

constexpr int kRingSides = 24, kTubeSides = 8;  // of a torus

void add_quad(Triangles& triangles, const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
}

[[noreturn]] void refuse(const std::string& path, size_t line, const std::string& why) {
    throw Error("'" + path + "', line " + std::to_string(line) + ": " + why);
}

}  // namespace

Triangles prism(const DVec3& a, const DVec3& b, const DVec3& x, const DVec3& y, int sides) {
    Triangles triangles;
    const bool turned = glm::dot(glm::cross(x, y), b - a) < 0.0;
    const auto side = [&](int i) {
        const SineCosine turn = portable_sine_cosine(2.0 * kPi * (turned ? sides - i : i) / sides);
        return x * turn.cosine + y * turn.sine;
    };
    for (int i = 0; i < sides; i++) {
        const DVec3 p = side(i), q = side((i + 1) % sides);
        add_quad(triangles, a + p, a + q, b + q, b + p);
        triangles.push_back({a, a + q, a + p});
        triangles.push_back({b, b + p, b + q});
    }
    return triangles;
}

Triangles box(const DVec3& middle, const DVec3& x, const DVec3& y, const DVec3& z) {
    Triangles triangles;
    const DVec3 axes[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        for (const double way : {1.0, -1.0}) {
            const DVec3 out = middle + way * axes[i], u = way * axes[(i + 1) % 3], v = axes[(i + 2) % 3];
            add_quad(triangles, out - u - v, out + u - v, out + u + v, out - u + v);
        }
    return triangles;
}

Triangles sheet(const DVec3& middle, const DVec3& x, const DVec3& y) {
    Triangles triangles;
    add_quad(triangles, middle - x - y, middle + x - y, middle + x + y, middle - x + y);
    return triangles;
}

Triangles torus(const DVec3& middle, const DVec3& axis, double radius, double thick) {
    const DVec3 x = any_perpendicular(axis), y = glm::cross(axis, x);
    const auto at = [&](int ring, int tube) {
        const SineCosine a = portable_sine_cosine(2.0 * kPi * (ring % kRingSides) / kRingSides),
                         b = portable_sine_cosine(2.0 * kPi * (tube % kTubeSides) / kTubeSides);
        return middle + (x * a.cosine + y * a.sine) * (radius + 0.5 * thick * b.cosine) +
               axis * (0.5 * thick * b.sine);
    };
    Triangles triangles;
    for (int ring = 0; ring < kRingSides; ring++)
        for (int tube = 0; tube < kTubeSides; tube++)
            add_quad(triangles, at(ring, tube), at(ring + 1, tube), at(ring + 1, tube + 1),
                     at(ring, tube + 1));
    return triangles;
}

Triangles read_triangles(const std::string& path) {
    const FileBytes bytes = read_file(path);
    std::vector<DVec3> points;
    Triangles triangles;
    size_t number = 0;
    for (std::string_view line : split(bytes.view(), '\n')) {
        number++;
        std::vector<std::string_view> words;
        for (const std::string_view word : split(line, ' '))
            if (!word.empty() && word != "\r") words.push_back(word.substr(0, word.find('\r')));
        if (words.empty()) continue;
        if (words[0] == "v") {
            DVec3 point(0.0);
            for (size_t i = 0; i < 3; i++) {
                const std::optional<double> value =
                    i + 1 < words.size() ? read_number(words[i + 1]) : std::nullopt;
                if (!value) refuse(path, number, "a point takes three numbers.");
                point[static_cast<int>(i)] = *value;
            }
            points.push_back(point);
        } else if (words[0] == "f") {
            std::vector<DVec3> corners;
            for (size_t i = 1; i < words.size(); i++) {
                const std::optional<double> index = read_number(words[i].substr(0, words[i].find('/')));
                const double count = static_cast<double>(points.size());
                const double at = !index ? 0.0 : *index < 0.0 ? count + *index + 1.0 : *index;
                if (!(at >= 1.0 && at <= count))
                    refuse(path, number, "a face names a point that is not there.");
                corners.push_back(points[static_cast<size_t>(at) - 1]);
            }
            for (size_t i = 2; i < corners.size(); i++)
                triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
    }
    if (triangles.empty()) throw Error("'" + path + "' has no faces: give a mesh as a Wavefront OBJ file.");
    return triangles;
}

}  // namespace treerec::growth
