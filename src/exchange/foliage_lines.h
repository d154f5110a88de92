// What a scan saw of leaves, in the comments of a tree file. Internal to exchange/.
//
// One line "# treerec foliage X Y Z EDGE REACH COLORED COUNT" (metres, axes of the tree; the place is that
// from the root to Foliage::origin), then lines "# treerec leaves" of some cells each: X Y Z POINTS, and R G
// B where COLORED is 1.
#pragma once

#include <string>
#include <string_view>

#include "foliage/foliage.h"
#include "geometry/vec.h"

namespace treerec {

// root: where the tree's root is in the foliage's space.
void append_foliage_lines(std::string& text, const Foliage& foliage, const DVec3& root);

// What is read of these lines, one after the other.
class FoliageLines {
  public:
    // Whether the comment tells of foliage. Throws Error where it is damaged; `path` is for the sentence.
    bool read(std::string_view comment, const std::string& path);
    // All of it, about a root at the origin; empty where there was none. Throws Error unless it is whole.
    Foliage take(const std::string& path);

  private:
    Foliage foliage_;
    size_t count_ = 0;
};

}  // namespace treerec
