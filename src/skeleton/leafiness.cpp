#include "skeleton/leafiness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr size_t kNeighbours = 32;
constexpr uint32_t kStride = 4;  // every fourth point is looked at; the others take their neighbours' mean
constexpr size_t kGrain = 4096;

// The eigenvalues of a symmetric matrix, falling (Smith 1961).
DVec3 eigenvalues(const DMat3& m) {
    const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
    const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3.0;
    const DVec3 diagonal = DVec3(m[0][0], m[1][1], m[2][2]) - mean;
    const double p = std::sqrt((glm::dot(diagonal, diagonal) + 2.0 * off) / 6.0);
    if (!(p > 0.0)) return DVec3(mean);
    DMat3 b = m;
    for (int i = 0; i < 3; i++)
        b[i][i] -= mean;
    const double r = std::clamp(glm::determinant(b) / (2.0 * p * p * p), -1.0, 1.0);
    const double angle = std::acos(r) / 3.0;
    const double first = mean + 2.0 * p * std::cos(angle);
    const double last = mean + 2.0 * p * std::cos(angle + 2.0 * kPi / 3.0);
    return {first, 3.0 * mean - first - last, last};
}

double linearity_at(uint32_t v, const std::vector<Vec3>& points, const PointGraph& graph,
                    std::vector<std::pair<float, uint32_t>>& near) {
    near.clear();
    auto add = [&](uint32_t n) {
        const Vec3 d = points[n] - points[v];
        near.emplace_back(glm::dot(d, d), n);
    };
    add(v);
    for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
        const uint32_t n = graph.neighbour[e];
        add(n);
        for (uint32_t f = graph.begin[n]; f < graph.begin[n + 1]; f++)
            if (graph.neighbour[f] != v) add(graph.neighbour[f]);
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    near.resize(std::min(near.size(), kNeighbours));
    DVec3 mean(0.0);
    for (const auto& [distance, n] : near)
        mean += DVec3(points[n]);
    mean /= static_cast<double>(near.size());
    DMat3 covariance(0.0);
    for (const auto& [distance, n] : near) {
        const DVec3 d = DVec3(points[n]) - mean;
        covariance += glm::outerProduct(d, d);
    }
    const DVec3 values = eigenvalues(covariance);
    return values.x > 0.0 ? std::clamp((values.x - values.y) / values.x, 0.0, 1.0) : 0.0;
}

}  // namespace

std::vector<float> neighbourhood_linearity(const std::vector<Vec3>& points, const PointGraph& graph,
                                           Progress& progress) {
    std::vector<float> linearity(points.size(), 0.0f);
    parallel_for(points.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        std::vector<std::pair<float, uint32_t>> near;
        for (size_t v = begin; v < end; v++)
            if (v % kStride == 0)
                linearity[v] =
                    static_cast<float>(linearity_at(static_cast<uint32_t>(v), points, graph, near));
    });
    for (uint32_t v = 0; v < points.size(); v++) {
        if (v % kStride == 0) continue;
        float sum = 0.0f;
        float count = 0.0f;
        for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++)
            if (graph.neighbour[e] % kStride == 0) {
                sum += linearity[graph.neighbour[e]];
                count += 1.0f;
            }
        linearity[v] = count > 0.0f ? sum / count : linearity[v - v % kStride];
    }
    return linearity;
}

}  // namespace treerec
