// Groups of things that are linked, directly or by others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "geometry/parallel.h"

namespace treerec {

// Sets that are joined two by two (union-find). Each is named by its smallest member, in whatever order they
// were joined.
class Groups {
  public:
    explicit Groups(size_t count) : leader_(count) { std::iota(leader_.begin(), leader_.end(), 0u); }

    size_t size() const { return leader_.size(); }

    // The smallest member of v's group.
    uint32_t find(uint32_t v) {
        while (leader_[v] != v)
            v = leader_[v] = leader_[leader_[v]];
        return v;
    }

    // By member: the smallest of its group.
    std::vector<uint32_t> names() {
        std::vector<uint32_t> names(size());
        for (uint32_t v = 0; v < size(); v++)
            names[v] = find(v);
        return names;
    }

    // Whether they were apart.
    bool join(uint32_t a, uint32_t b) {
        a = find(a);
        b = find(b);
        leader_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

    // links(v, link) calls link(n) for each n that v is linked to; one of both need to know. It is called on
    // several threads: those who lie in the same stretch of indices are joined there, and the links between
    // stretches, which are few where neighbours have near indices, afterwards.
    template <typename Links>
    void join_all(const Links& links) {
        constexpr size_t kStretch = 2048;
        using Link = std::pair<uint32_t, uint32_t>;
        std::vector<std::vector<Link>> between((size() + kStretch - 1) / kStretch);
        parallel_for(size(), kStretch, [&](size_t begin, size_t end) {
            std::vector<Link>& out = between[begin / kStretch];
            for (uint32_t v = static_cast<uint32_t>(begin); v < end; v++)
                links(v, [&](uint32_t n) {
                    if (n >= begin && n < end)
                        join(v, n);
                    else
                        out.emplace_back(v, n);
                });
        });
        for (const std::vector<Link>& some : between)
            for (const auto& [v, n] : some)
                join(v, n);
    }

  private:
    std::vector<uint32_t> leader_;
};

}  // namespace treerec
