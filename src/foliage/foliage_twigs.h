// The twigs that a leafy scan hides: wood for the leaves that it saw.
#pragma once

#include <vector>

#include "foliage/foliage.h"
#include "foliage/leaf_rule_text.h"
#include "foliage/leaf_rules.h"
#include "tree/tree.h"

namespace treerec {

// The tree with thin twigs (kGuessFlag) that reach from its wood into every part of the foliage, at the
// angles and as thick as those of its own that were seen (own_twigs.h), so that the leaves there stand on
// bark: what place_leaves() stands them on, and what their bark is to be built of. Where the rules do not
// follow the foliage, and where there is none, the tree itself. Nodes keep their ids; new ones follow. It
// depends on nothing of the rules but whether they follow the foliage. None grow where the foliage is farther
// than about a metre (Foliage::reach, if that is more) from the tree's own wood.
Tree leafy_tree(const Tree& tree, const LeafRules& rules, const Foliage& foliage);
// The same where wood bears leaves of several kinds (leaf_kinds()): twigs stay on that whose rules follow it.
Tree leafy_tree(const Tree& tree, const std::vector<LeafKind>& kinds, const Foliage& foliage);

// Whether leaves by these rules stand where the scan saw any.
bool follows(const LeafRules& rules, const Foliage& foliage);

// How far leaves may stand from the tree's own wood, metres. height: the tree's, metres.
double foliage_reach(const Foliage& foliage, double height);

// Metres between the ends of such twigs: no leaf stands much farther than half of it from wood.
double foliage_twig_spacing(const Foliage& foliage);

}  // namespace treerec
