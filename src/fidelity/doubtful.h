// Branches that the scan hardly supports.
#pragma once

#include <string>
#include <vector>

#include "fidelity/fidelity.h"
#include "tree/tree.h"

namespace treerec {

// What speaks against a branch; bits.
enum DoubtReason : uint8_t {
    kFewPoints = 1,         // most of its bark has no point on it
    kLongBridge = 2,        // much of it crosses a gap of the scan
    kImprobableAngle = 4,   // it turns back along its parent
    kThickerThanParent = 8  // than the wood that it grows from
};

struct DoubtfulBranch {
    NodeId node = kNoNode;    // its first own node: removing the subtree there removes the branch
    NodeId attach = kNoNode;  // where it grows from
    uint8_t reasons = 0;      // DoubtReason
    double doubt = 0.0;       // 0..1
    double length = 0.0;      // metres
    size_t points = 0;        // nearest to its own bark
    double bridged = 0.0;     // metres across gaps
    double angle = 0.0;       // degrees between its first 0.1 m and its parent there
    double thickness = 1.0;   // its radius where it sets out, as a share of its parent's
};

// Most doubtful metres first (doubt times length, then by the node). fidelity: of this tree. The first branch
// and ends shorter than twice their parent's radius are not judged. Linear. Throws Error where the arguments
// do not belong together.
std::vector<DoubtfulBranch> find_doubtful(const Tree& tree, const Fidelity& fidelity);

// "few points, a long bridge"
std::string doubt_text(uint8_t reasons);

}  // namespace treerec
