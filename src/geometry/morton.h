// An order of points in which neighbours in space are mostly neighbours.
#pragma once

#include <span>
#include <vector>

#include "geometry/radix_sort.h"
#include "geometry/vec.h"

namespace treerec {

// Sorts items, which name points by their indices, into the Morton order of these within the box around them
// (2048 cells wide); points of one cell stay as they were. Points that are not finite come anywhere. Throws
// Cancelled.
void sort_morton(std::span<const Vec3> points, std::vector<KeyedIndex>& items,
                 const Progress* progress = nullptr);

// The indices of all points in that order.
std::vector<KeyedIndex> morton_order(std::span<const Vec3> points, const Progress* progress = nullptr);

}  // namespace treerec
